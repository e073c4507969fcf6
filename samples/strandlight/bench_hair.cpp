// strandlight bench hair: held-out pictures of hair by method, against a supersampled truth.
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/hair_head.hpp"
#include "passes/hair_network.hpp"
#include "passes/hair_study.hpp"
#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

namespace {

struct HairBench
{
    BenchOptions common;
    std::string weights;
    std::string out; // folder of strips
    std::string mohawk;
};

struct Method
{
    std::string name;
    HairFilter filter = HairFilter::Average;
    std::uint32_t frames = 1;
};

// The first one is what the others' errors are divided by.
std::vector<Method> methodsOf(bool quick, bool network)
{
    std::vector<Method> methods = {{"4 averaged"},
                                   {"16 averaged", HairFilter::Average, 4},
                                   {"64 averaged", HairFilter::Average, 16}};
    if (!quick)
        methods.push_back({"256 averaged", HairFilter::Average, 64});
    methods.push_back({"4 alpha to coverage", HairFilter::AlphaToCoverage});
    methods.push_back({"4 coverage", HairFilter::Coverage});
    methods.push_back({"blend", HairFilter::Blend});
    if (network)
        methods.push_back({"4 U-Net", HairFilter::UNet});
    return methods;
}

double millisecondsOf(const HairFrame& frame, const std::string& part)
{
    double sum = 0.0;
    for (const PassTiming& timing : frame.timings)
        sum += timing.pass.find(part) != std::string::npos ? timing.milliseconds : 0.0;
    return sum;
}

// Pictures side by side.
CpuImage strip(const std::vector<CpuImage>& pictures)
{
    CpuImage all(pictures[0].width * std::uint32_t(pictures.size()), pictures[0].height);
    for (std::uint32_t i = 0; i < pictures.size(); ++i)
        for (std::uint32_t y = 0; y < all.height; ++y)
            for (std::uint32_t x = 0; x < pictures[i].width; ++x)
                all.at(i * pictures[i].width + x, y) = pictures[i].at(x, y);
    return all;
}

class CaseBench
{
public:
    CaseBench(Context& context, const HairBench& options, HairNetwork* network,
              const HairStudyCase& subject)
        : context_(context), options_(options), network_(network), subject_(subject)
    {
        settings_.width = options.common.quick ? 320 : 640;
        settings_.height = options.common.quick ? 192 : 384;
        settings_.lod = 1;
        settings_.network = network;
        if (subject.onHead)
            head_ = headScene();
    }

    void run(BenchReport& report)
    {
        HairRenderSettings settings = settings_;
        settings.mode = HairMode::Reference;
        settings.frames = options_.common.quick ? 64 : 256;
        const HairFrame truth = render(settings);
        std::vector<CpuImage> pictures;
        double base = 0.0;
        for (const Method& method : methodsOf(options_.common.quick, network_ != nullptr)) {
            throwIfInterrupted();
            const HairFrame frame = render(settingsOf(method));
            const HairError error = compareHair(frame, truth);
            base = pictures.empty() ? error.picture.rmse : base;
            if (pictures.empty() || method.filter == HairFilter::UNet)
                pictures.push_back(frame.radiance);
            report.add({{"name", subject_.name + " " + method.name},
                        {"rmse", error.picture.rmse},
                        {"rmse_over_4", error.picture.rmse / base},
                        {"psnr_db", error.picture.psnr},
                        {"ssim", error.picture.ssim},
                        {"flip", error.picture.flip},
                        {"coverage_error", error.coverage},
                        {"flicker", flickerOf(method, frame)},
                        {"ms", millisecondsOf(frame, "")},
                        {"ms_shadow", millisecondsOf(frame, "shadow")},
                        {"ms_strands", millisecondsOf(frame, "hair strands")}});
        }
        pictures.push_back(truth.radiance);
        if (!options_.out.empty())
            writePicture(options_.out + "/" + subject_.name + ".png", strip(pictures), 0.0f);
    }

private:
    HairRenderSettings settingsOf(const Method& method) const
    {
        HairRenderSettings settings = settings_;
        settings.filter = method.filter;
        settings.frames = method.frames;
        return settings;
    }

    HairFrame render(const HairRenderSettings& settings)
    {
        return renderHair(context_, subject_.hair, head_ ? &*head_ : nullptr, subject_.camera,
                          settings);
    }

    // Between a frame and one with other noise a pixel on.
    double flickerOf(const Method& method, const HairFrame& first)
    {
        HairRenderSettings settings = settingsOf(method);
        settings.frameIndex = method.frames;
        settings.lensShift = {1.0f, 0.0f};
        return hairFlicker(first, render(settings));
    }

    Context& context_;
    const HairBench& options_;
    HairNetwork* network_;
    const HairStudyCase& subject_;
    HairRenderSettings settings_;
    std::optional<Scene> head_;
};

int benchHair(const HairBench& o)
{
    Context context = openDevice(o.common.device);
    BenchReport report("bench hair", o.common, context);
    std::optional<HairNetwork> network;
    if (!o.weights.empty())
        network = loadHairNetwork(context, o.weights);
    else if (!builtinHairWeights().empty())
        network = builtinHairNetwork(context);
    const std::vector<HairStudyCase> cases = heldOutHair(o.mohawk, o.common.quick ? 4000 : 0);
    Progress progress("bench hair", cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        progress.update(i);
        if (report.wants(cases[i].name))
            CaseBench(context, o, network ? &*network : nullptr, cases[i]).run(report);
    }
    progress.update(cases.size());
    report.finish();
    return 0;
}

std::string mohawkFile()
{
    const char* data = std::getenv("STRANDLIGHT_DATA");
    return std::string(data ? data : "../shared/data") + "/hair/ratboy_mohawk.tfx";
}

} // namespace

Command addBenchHair(CLI::App& bench)
{
    CLI::App* app = bench.add_subcommand(
        "hair", "Held-out frames by number of samples and filter, against the truth");
    const auto o = std::make_shared<HairBench>();
    o->mohawk = mohawkFile();
    addBenchOptions(*app, o->common);
    app->add_option("--weights", o->weights, "Of the network; default: those built in")
        ->type_name("FILE");
    app->add_option("--out", o->out, "Folder for strips: 4 averaged, network, truth")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory);
    app->add_option("--mohawk", o->mohawk, "The sixth frame's file; a groom where it is none")
        ->type_name("FILE");
    addExamples(*app, "  strandlight bench hair --quick --out strips --json hair.json\n"
                      "  strandlight bench hair --filter ponytail");
    return {app, [o] { return benchHair(*o); }};
}

} // namespace strandlight::cli
