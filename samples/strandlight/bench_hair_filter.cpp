// strandlight bench hair-filter: the filter's network over pictures that hair covers in part, by
// tiles and as a whole.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "engine/base/error.hpp"
#include "passes/hair_filter.hpp"
#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    BenchOptions bench;
    std::string size = "640x384";
    std::uint32_t runs = 5;
    bool byPass = false;
};

// A disc of black hair that covers a share of the picture, as a head does: transmittance in w.
CpuImage disc(Size size, double share)
{
    CpuImage blended(size.width, size.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    const auto distance = [&](std::size_t i) {
        const double x = double(i % size.width) + 0.5 - 0.5 * size.width;
        const double y = double(i / size.width) + 0.5 - 0.5 * size.height;
        return std::hypot(x, y);
    };
    std::vector<double> sorted(blended.pixels.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
        sorted[i] = distance(i);
    std::sort(sorted.begin(), sorted.end());
    const auto covered = std::size_t(share * double(sorted.size()));
    for (std::size_t i = 0; covered > 0 && i < sorted.size(); ++i)
        if (distance(i) <= sorted[covered - 1])
            blended.pixels[i].w = 0.4f;
    return blended;
}

struct Run
{
    Timing timing;
    std::vector<PassTiming> passes;
    CpuImage radiance;
};

// Samples are cleared, not drawn: the filter's time does not depend on what they hold.
Run runFilter(Context& context, const UNetDesc& net, Parameters& parameters, const CpuImage& hair,
              bool skipTiles, std::uint32_t runs)
{
    const ImageDesc desc{hair.width, hair.height, 1, Format::RGBA32F, 1};
    ImageDesc four = desc.with(Format::RGBA16F);
    four.samples = 4;
    Image blended(context, desc, "blended"), filtered(context, desc, "filtered");
    Image radiance(context, desc, "radiance"), features(context, four, "features");
    Image shape(context, four, "shape");
    blended.upload(hair);
    RenderGraph graph(context);
    HairFilterInput input;
    input.samples.features = graph.importImage(features);
    input.samples.shape = graph.importImage(shape);
    input.blended = graph.importImage(blended);
    const ParameterIds weights(graph, parameters);
    addHairFilterPasses(graph, net, weights, input,
                        {graph.importImage(filtered), graph.importImage(radiance)},
                        {.skipTiles = skipTiles});
    const Timing timing = timeGraph(graph, runs);
    std::vector<PassTiming> passes = timePasses(graph, runs);
    return {timing, std::move(passes), radiance.download()};
}

// A row for every pass of the tiles; lists of them have no dense time.
void addPassRows(BenchReport& report, const std::string& name, const Run& dense, const Run& tiles)
{
    for (const PassTiming& pass : tiles.passes) {
        Json row = {{"name", name + ": " + pass.pass}, {"tiles_ms", pass.milliseconds}};
        for (const PassTiming& same : dense.passes)
            if (same.pass == pass.pass) {
                row["dense_ms"] = same.milliseconds;
                row["over_dense"] = pass.milliseconds / same.milliseconds;
            }
        report.add(row);
    }
}

int run(const Options& o)
{
    Context context = openDevice(o.bench.device);
    BenchReport report("bench hair-filter", o.bench, context);
    const Size size = o.bench.quick ? Size{160, 96} : parseSize(o.size);
    const std::uint32_t runs = o.bench.quick ? 1 : o.runs;
    report.about()["settings"]["size"] = {size.width, size.height};
    report.about()["settings"]["network"] = "hairUNet small, initial weights";
    const UNetDesc net = hairUNet(HairUNetSize::Small);
    Parameters parameters(context, net.parameters(), 1);
    for (const double share : {1.0, 0.3, 0.1, 0.0}) {
        const std::string name = "hair " + fixed(100.0 * share, 0) + " %";
        if (!report.wants(name))
            continue;
        const CpuImage hair = disc(size, share);
        const Run dense = runFilter(context, net, parameters, hair, false, runs);
        const Run tiles = runFilter(context, net, parameters, hair, true, runs);
        if (std::memcmp(dense.radiance.pixels.data(), tiles.radiance.pixels.data(),
                        dense.radiance.pixels.size() * sizeof(glm::vec4)) != 0)
            throw Error(name + ": tiles give other bits than the whole picture");
        report.add({{"name", name},
                    {"dense_ms", dense.timing.median},
                    {"tiles_ms", tiles.timing.median},
                    {"over_dense", tiles.timing.median / dense.timing.median},
                    {"runs", runs}});
        if (o.byPass)
            addPassRows(report, name, dense, tiles);
    }
    report.finish();
    return 0;
}

} // namespace

Command addBenchHairFilter(CLI::App& bench)
{
    CLI::App* app = bench.add_subcommand(
        "hair-filter", "The filter's network by tiles against the whole picture, same bits first");
    const auto o = std::make_shared<Options>();
    addBenchOptions(*app, o->bench);
    app->add_option("--size", o->size, "Of the picture")->type_name("WxH")->capture_default_str();
    app->add_flag("--passes", o->byPass, "Also a row for each pass");
    addExamples(*app, "  strandlight bench hair-filter --size 1280x720 --json filter.json");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
