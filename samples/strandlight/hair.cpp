// strandlight hair: pictures of hair files and built-in grooms.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "passes/hair_network.hpp"
#include "passes/hair_render.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/hair_stats.hpp"
#include "samples/strandlight/hair_surroundings.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

constexpr std::uint32_t kSamplesPerFrame = 4; // of MSAA
constexpr std::uint32_t kMostSamples = 1u << 14;
constexpr std::uint32_t kMostLod = 256;

struct Options
{
    DeviceOptions device;
    HairOptions source;
    ViewOptions view;
    HairRenderSettings settings;
    std::uint32_t samples = kSamplesPerFrame;
    std::string filter = "average";
    std::string weights;
    std::string precision = "fp32";
    std::string fuseFetch = "auto";
    std::string lod = "auto";
    bool stats = false;
    std::string json;
};

std::uint32_t parseLod(const std::string& text)
{
    if (text == "auto")
        return 0;
    for (std::uint32_t k = 1; k <= kMostLod; ++k)
        if (text == std::to_string(k))
            return k;
    throw Error("--lod: '" + text + "' is neither auto nor 1 .. " + std::to_string(kMostLod));
}

struct NamedFilter
{
    const char* name;
    HairFilter filter;
};
constexpr NamedFilter kFilters[] = {
    {"none", HairFilter::None},         {"average", HairFilter::Average},
    {"coverage", HairFilter::Coverage}, {"a2c", HairFilter::AlphaToCoverage},
    {"blend", HairFilter::Blend},       {"unet", HairFilter::UNet}};

std::vector<std::string> filterNames()
{
    std::vector<std::string> names;
    for (const NamedFilter& named : kFilters)
        names.push_back(named.name);
    return names;
}

HairFilter filterOf(const Options& o)
{
    const auto chosen =
        std::find_if(std::begin(kFilters), std::end(kFilters),
                     [&](const NamedFilter& named) { return o.filter == named.name; });
    if (chosen->filter == HairFilter::UNet && o.samples != kSamplesPerFrame)
        throw Error("--samples: the network of --filter unet reads four samples, not " +
                    std::to_string(o.samples));
    if (chosen->filter != HairFilter::UNet && !o.weights.empty())
        throw Error("--weights: only --filter unet has any");
    if (chosen->filter != HairFilter::UNet && o.precision != "fp32")
        throw Error("--precision: only --filter unet has any");
    if (chosen->filter != HairFilter::UNet && o.fuseFetch != "auto")
        throw Error("--fuse-fetch: only --filter unet has an input to fetch");
    return chosen->filter;
}

std::optional<HairNetwork> openNetwork(Context& context, const Options& o)
{
    if (o.settings.filter != HairFilter::UNet)
        return std::nullopt;
    return o.weights.empty() ? builtinHairNetwork(context) : loadHairNetwork(context, o.weights);
}

std::uint32_t framesOf(std::uint32_t samples, const char* option)
{
    if (samples % kSamplesPerFrame != 0)
        throw Error(std::string(option) + ": " + std::to_string(samples) +
                    " is not a multiple of " + std::to_string(kSamplesPerFrame));
    return samples / kSamplesPerFrame;
}

// What the user gave of a groom's settings.
Json describeGroom(const GroomOptions& o)
{
    Json json = Json::object();
    const auto add = [&](const char* name, const auto& value) {
        if (value)
            json[name] = *value;
    };
    add("segments", o.segments);
    add("length", o.length);
    add("clumping", o.clumping);
    add("frizz", o.frizz);
    add("color_variation", o.colorVariation);
    add("seed", o.seed);
    return json;
}

Json describe(const std::string& command, const Options& o, const Context& context,
              const Camera& camera, const HairStrands& hair, const HairFrame& frame, double seconds)
{
    Json json = describeRun(command, &context);
    json["settings"] = {{"hair", o.source.hair},
                        {"scene", o.source.scene},
                        {"bake", o.source.bake},
                        {"environment", o.source.environment},
                        {"groom", describeGroom(o.source.groom)},
                        {"strands", hair.strandCount()},
                        {"segments", hair.segmentCount()},
                        {"width_factor", o.source.width},
                        {"width", o.settings.width},
                        {"height", o.settings.height},
                        {"camera", describeCamera(camera)},
                        {"samples", o.settings.frames * kSamplesPerFrame},
                        {"filter", o.filter},
                        {"weights", o.weights},
                        {"precision", o.precision},
                        {"frame", o.settings.frameIndex},
                        {"shadows", o.settings.shadows},
                        {"exposure", o.view.exposure}};
    Json passes = Json::array();
    for (const PassTiming& timing : frame.timings)
        passes.push_back({{"name", timing.pass}, {"milliseconds", timing.milliseconds}});
    json["result"] = {{"files", o.view.outputs},
                      {"lod", frame.lod},
                      {"drawn_strands", frame.drawnStrands},
                      {"drawn_segments", frame.drawnSegments},
                      {"passes", passes},
                      {"tiles", describeTiles(frame)},
                      {"skipped", frame.skipped},
                      {"blocks", frame.blocks},
                      {"empty_blocks", frame.emptyBlocks},
                      {"milliseconds", totalMilliseconds(frame)},
                      {"peak_device_bytes", context.peakBytesAllocated()},
                      {"seconds", seconds}};
    return json;
}

int run(const std::string& command, Options& o)
{
    const auto start = std::chrono::steady_clock::now();
    for (const std::string& output : o.view.outputs)
        requireOutput(output, {".png", ".exr"});
    requireOutput(o.json, {".json"});
    const Size size = parseSize(o.view.size);
    o.settings.width = size.width;
    o.settings.height = size.height;
    const HairStrands hair = openHair(o.source);
    const HairSurroundings around = openSurroundings(o.source, hair);
    o.settings.distant = around.distant;
    const Camera camera =
        o.view.camera.empty() ? hairCamera(hair) : chooseCamera(Scene{}, o.view.camera);
    Context context = openDevice(o.device);
    std::optional<HairNetwork> network = openNetwork(context, o);
    o.settings.network = network ? &*network : nullptr;

    HairFrame behind; // its record alone
    CpuImage background;
    if (around.bake) {
        background = renderBehind(context, around, camera, o.settings, behind);
        o.settings.background = &background;
    }
    HairFrame frame =
        renderHair(context, hair, around.opaque ? &*around.opaque : nullptr, camera, o.settings);
    frame.timings.insert(frame.timings.begin(), behind.timings.begin(), behind.timings.end());
    frame.skipped.insert(frame.skipped.begin(), behind.skipped.begin(), behind.skipped.end());
    throwIfInterrupted();
    for (const std::string& output : o.view.outputs)
        writePicture(output, frame.radiance, o.view.exposure);

    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (o.stats)
        printHairStats(context, hair, frame);
    for (const std::string& output : o.view.outputs)
        std::printf("wrote     %s, %.1f s\n", output.c_str(), elapsed.count());
    writeJson(o.json, describe(command, o, context, camera, hair, frame, elapsed.count()));
    return 0;
}

void addPictureOptions(CLI::App& app, Options& o)
{
    addHairOptions(app, o.source);
    o.view.size = "640x384";
    addViewOptions(app, o.view);
    app.add_flag("!--no-shadows", o.settings.shadows, "Do not let hair shadow itself");
    app.add_flag("--stats", o.stats,
                 "Print passes that ran, milliseconds, tiles, and what was culled");
    addJsonOption(app, o.json);
    addDeviceOptions(app, o.device);
}

Command addHairRender(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("render", "Stochastic transparency, samples averaged");
    const auto o = std::make_shared<Options>();
    addPictureOptions(*app, *o);
    addNumber(*app, "--samples", o->samples, "Per pixel, a multiple of 4", 4u, kMostSamples);
    app->add_option("--filter", o->filter,
                    "average: of the samples; coverage: scaled to the exact coverage as well; "
                    "a2c: the device's alpha to coverage instead of random masks; none: one sample "
                    "alone; unet: a trained network")
        ->type_name("FILTER")
        ->capture_default_str()
        ->check(CLI::IsMember(filterNames()));
    app->add_option("--weights", o->weights, "Of the network; default: those built in")
        ->type_name("F.safetensors");
    app->add_option("--precision", o->precision,
                    "How the network's activations are stored; sums are fp32 always")
        ->type_name("fp32|fp16")
        ->capture_default_str()
        ->check(CLI::IsMember({"fp32", "fp16"}));
    app->add_option("--fuse-fetch", o->fuseFetch,
                    "Of the network: fetch its input where layers read it, for less memory, or "
                    "store it first; auto: off, as it is slower on CPUs and not measured on GPUs")
        ->type_name("on|off|auto")
        ->capture_default_str()
        ->check(CLI::IsMember({"on", "off", "auto"}));
    addNumber(*app, "--frame", o->settings.frameIndex, "Another frame has other noise", 0u,
              1u << 24);
    app->add_option("--lod", o->lod,
                    "Draw every K-th strand K times wider; auto: by projected width")
        ->type_name("auto|K")
        ->capture_default_str();
    addExamples(
        *app,
        "  strandlight hair render builtin:wavy -o wavy.png --stats\n"
        "  strandlight hair render builtin:wavy --scene builtin:bust --bake bust.sgl -o room.png\n"
        "  strandlight hair render mohawk.tfx -o mohawk.png --samples 16 --lod 2");
    return {app, [o] {
                o->settings.frames = framesOf(o->samples, "--samples");
                o->settings.filter = filterOf(*o);
                o->settings.halves = o->precision == "fp16";
                if (o->fuseFetch != "auto")
                    o->settings.fuseFetch = o->fuseFetch == "on";
                o->settings.lod = parseLod(o->lod);
                return run("hair render", *o);
            }};
}

Command addHairReference(CLI::App& parent)
{
    CLI::App* app =
        parent.add_subcommand("reference", "The truth: strands of true width, supersampled");
    const auto o = std::make_shared<Options>();
    o->samples = 256;
    addPictureOptions(*app, *o);
    addNumber(*app, "--spp", o->samples, "Per pixel, a multiple of 4", 4u, kMostSamples);
    addExamples(*app, "  strandlight hair reference builtin:wavy -o truth.exr --spp 1024");
    return {app, [o] {
                o->settings.mode = HairMode::Reference;
                o->settings.frames = framesOf(o->samples, "--spp");
                o->settings.lod = 1;
                return run("hair reference", *o);
            }};
}

} // namespace

Command addHair(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("hair", "Hair with stochastic transparency");
    app->require_subcommand(1);
    const Command commands[] = {addHairRender(*app), addHairReference(*app), addHairTrain(*app)};
    return {app, [commands = std::to_array(commands)] {
                for (const Command& command : commands)
                    if (command.app->parsed())
                        return command.run();
                throw Error("hair: no command");
            }};
}

} // namespace strandlight::cli
