// strandlight bench hair-filter: the filter's network over pictures that hair covers in part, as a
// whole, by tiles, and by tiles with the input fetched by the layers that read it.
#include <algorithm>
#include <array>
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
    std::uint32_t runs = 9;
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

enum Form
{
    Dense,
    Tiles,
    Fused, // tiles, and the input fetched by the layers that read it
    kForms
};

// One picture in one form. Samples are cleared, not drawn: the filter's time does not depend on
// what they hold.
class FilterFrame
{
public:
    FilterFrame(Context& context, const UNetDesc& net, Parameters& parameters, const CpuImage& hair,
                Form form)
        : blended_(context, floats(hair), "blended"), filtered_(context, floats(hair), "filtered"),
          radiance_(context, floats(hair), "radiance"), features_(context, four(hair), "features"),
          shape_(context, four(hair), "shape"), graph_(context)
    {
        blended_.upload(hair);
        HairFilterInput input;
        input.samples.features = graph_.importImage(features_);
        input.samples.shape = graph_.importImage(shape_);
        input.blended = graph_.importImage(blended_);
        const ParameterIds weights(graph_, parameters);
        addHairFilterPasses(graph_, net, weights, input,
                            {graph_.importImage(filtered_), graph_.importImage(radiance_)},
                            {.skipTiles = form != Dense, .fuseFetch = form == Fused});
        mib_ = double(graph_.compile().arenaBytes) / double(1 << 20);
    }

    RenderGraph& graph() { return graph_; }
    double mib() const { return mib_; } // of the graph's transients, which share memory
    CpuImage radiance() const { return radiance_.download(); }

private:
    static ImageDesc floats(const CpuImage& hair)
    {
        return {hair.width, hair.height, 1, Format::RGBA32F, 1};
    }
    static ImageDesc four(const CpuImage& hair)
    {
        ImageDesc desc = floats(hair).with(Format::RGBA16F);
        desc.samples = 4;
        return desc;
    }

    Image blended_, filtered_, radiance_, features_, shape_;
    RenderGraph graph_;
    double mib_ = 0.0;
};

// A row for every pass of any form; a form without it has no time there.
void addPassRows(BenchReport& report, const std::string& name,
                 const std::array<std::vector<PassTiming>, kForms>& passes)
{
    std::vector<std::string> names;
    for (const std::vector<PassTiming>& form : {passes[Tiles], passes[Fused]})
        for (const PassTiming& pass : form)
            if (std::find(names.begin(), names.end(), pass.pass) == names.end())
                names.push_back(pass.pass);
    for (const std::string& pass : names) {
        Json row = {{"name", name + ": " + pass}};
        const auto add = [&](const char* column, Form form) {
            for (const PassTiming& same : passes[form])
                if (same.pass == pass)
                    row[column] = row.value(column, 0.0) + same.milliseconds; // of all bands
        };
        add("dense_ms", Dense);
        add("tiles_ms", Tiles);
        add("fused_ms", Fused);
        report.add(row);
    }
}

void requireSameBits(const std::string& name, const CpuImage& form, const CpuImage& dense)
{
    if (std::memcmp(dense.pixels.data(), form.pixels.data(),
                    dense.pixels.size() * sizeof(glm::vec4)) != 0)
        throw Error("bench hair-filter: " + name + " gives other bits than the whole picture");
}

void measure(BenchReport& report, const std::string& name, std::array<FilterFrame*, kForms> frames,
             std::uint32_t runs, bool byPass)
{
    for (FilterFrame* frame : frames)
        frame->graph().execute();
    requireSameBits(name + " by tiles", frames[Tiles]->radiance(), frames[Dense]->radiance());
    requireSameBits(name + " with a fused fetch", frames[Fused]->radiance(),
                    frames[Dense]->radiance());
    RenderGraph* const graphs[] = {&frames[Dense]->graph(), &frames[Tiles]->graph(),
                                   &frames[Fused]->graph()};
    const RoundTimings timings(graphs, runs);
    report.add({{"name", name},
                {"dense_ms", timings.of(Dense).median},
                {"tiles_ms", timings.of(Tiles).median},
                {"over_dense", timings.ratio(Tiles, Dense)},
                {"tiles_mib", frames[Tiles]->mib()},
                {"fused_ms", timings.of(Fused).median},
                {"fused_over_tiles", timings.ratio(Fused, Tiles)},
                {"fused_mib", frames[Fused]->mib()},
                {"runs", runs}});
    if (!byPass)
        return;
    std::array<std::vector<PassTiming>, kForms> passes;
    for (std::size_t form = 0; form < kForms; ++form)
        passes[form] = timePasses(*graphs[form], runs);
    addPassRows(report, name, passes);
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
        FilterFrame dense(context, net, parameters, hair, Dense);
        FilterFrame tiles(context, net, parameters, hair, Tiles);
        FilterFrame fused(context, net, parameters, hair, Fused);
        measure(report, name, {&dense, &tiles, &fused}, runs, o.byPass);
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
