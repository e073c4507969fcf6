// strandlight bench hair-filter: the filter's network over pictures that hair covers in part, as a
// whole, by tiles, and by tiles with the input fetched by the layers that read it.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/graph/plan.hpp"
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
    double mib = 0.0; // of the graph's transients, which share memory
    std::vector<PassTiming> passes;
    CpuImage radiance;
};

// Samples are cleared, not drawn: the filter's time does not depend on what they hold.
Run runFilter(Context& context, const UNetDesc& net, Parameters& parameters, const CpuImage& hair,
              bool skipTiles, bool fuseFetch, std::uint32_t runs)
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
                        {.skipTiles = skipTiles, .fuseFetch = fuseFetch});
    const double mib = double(graph.compile().arenaBytes) / double(1 << 20);
    const Timing timing = timeGraph(graph, runs);
    std::vector<PassTiming> passes = timePasses(graph, runs);
    return {timing, mib, std::move(passes), radiance.download()};
}

// A row for every pass of any form; a form without it has no time there.
void addPassRows(BenchReport& report, const std::string& name, const Run& dense, const Run& tiles,
                 const Run& fused)
{
    std::vector<std::string> names;
    for (const Run* run : {&tiles, &fused})
        for (const PassTiming& pass : run->passes)
            if (std::find(names.begin(), names.end(), pass.pass) == names.end())
                names.push_back(pass.pass);
    for (const std::string& pass : names) {
        Json row = {{"name", name + ": " + pass}};
        const auto add = [&](const char* column, const Run& run) {
            for (const PassTiming& same : run.passes)
                if (same.pass == pass)
                    row[column] = same.milliseconds;
        };
        add("dense_ms", dense);
        add("tiles_ms", tiles);
        add("fused_ms", fused);
        report.add(row);
    }
}

void requireSameBits(const std::string& name, const char* form, const Run& run, const Run& dense)
{
    if (std::memcmp(dense.radiance.pixels.data(), run.radiance.pixels.data(),
                    dense.radiance.pixels.size() * sizeof(glm::vec4)) != 0)
        throw Error(name + ": " + form + " gives other bits than the whole picture");
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
        const Run dense = runFilter(context, net, parameters, hair, false, false, runs);
        const Run tiles = runFilter(context, net, parameters, hair, true, false, runs);
        const Run fused = runFilter(context, net, parameters, hair, true, true, runs);
        requireSameBits(name, "by tiles", tiles, dense);
        requireSameBits(name, "the fused fetch", fused, dense);
        report.add({{"name", name},
                    {"dense_ms", dense.timing.median},
                    {"tiles_ms", tiles.timing.median},
                    {"over_dense", tiles.timing.median / dense.timing.median},
                    {"tiles_mib", tiles.mib},
                    {"fused_ms", fused.timing.median},
                    {"fused_over_tiles", fused.timing.median / tiles.timing.median},
                    {"fused_mib", fused.mib},
                    {"runs", runs}});
        if (o.byPass)
            addPassRows(report, name, dense, tiles, fused);
    }
    report.finish();
    return 0;
}

} // namespace

Command addBenchHairFilter(CLI::App& bench)
{
    CLI::App* app = bench.add_subcommand(
        "hair-filter", "The filter's network by tiles, and with its input fused, against the whole "
                       "picture: same bits first");
    const auto o = std::make_shared<Options>();
    addBenchOptions(*app, o->bench);
    app->add_option("--size", o->size, "Of the picture")->type_name("WxH")->capture_default_str();
    app->add_flag("--passes", o->byPass, "Also a row for each pass");
    addExamples(*app, "  strandlight bench hair-filter --size 1280x720 --json filter.json");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
