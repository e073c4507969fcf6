// strandlight bench hair: held-out pictures of hair by method, against a supersampled truth.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "engine/base/cache_folder.hpp"
#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/hair_head.hpp"
#include "passes/hair_study.hpp"
#include "passes/hair_truth.hpp"
#include "samples/strandlight/bench_hair.hpp"

namespace strandlight::cli {

namespace {

struct HairBench
{
    BenchOptions common;
    std::vector<std::string> weights;
    std::uint32_t samples = 0; // of the truth; 0: 1024, quick 256
    bool keep = true;          // truths in the cache folder
    std::string out;           // folder of pictures
    std::string mohawk;
};

double millisecondsOf(const HairFrame& frame, const std::string& part)
{
    double sum = 0.0;
    for (const PassTiming& timing : frame.timings)
        sum += timing.pass.find(part) != std::string::npos ? timing.milliseconds : 0.0;
    return sum;
}

// Of the network's layers, what they read and which tiles they do.
double networkMilliseconds(const HairFrame& frame)
{
    double sum = 0.0;
    for (const PassTiming& timing : frame.timings)
        for (const char* start : {"enc", "dec", "out", "unet", "hair network", "hair touched"})
            sum += timing.pass.starts_with(start) ? timing.milliseconds : 0.0;
    return sum;
}

std::uint32_t truthSamples(const HairBench& o)
{
    return o.samples > 0 ? o.samples : o.common.quick ? 256 : 1024;
}

// Nothing is timed that is not a picture of the truth, however noisy.
void check(const std::string& name, const HairError& error)
{
    if (error.picture.nonFinite > 0 || !(error.picture.ssim > 0.5))
        throw Error(name + ": " + std::to_string(error.picture.nonFinite) +
                    " pixels are not finite, SSIM is " + fixed(error.picture.ssim, 3));
}

class CaseBench
{
public:
    CaseBench(Context& context, const HairBench& options, std::vector<NamedHairNetwork>& networks,
              const HairStudyCase& subject)
        : context_(context), options_(options), networks_(networks), subject_(subject)
    {
        settings_.width = options.common.quick ? 320 : 640;
        settings_.height = options.common.quick ? 192 : 384;
        settings_.lod = 1;
        if (subject.onHead)
            head_ = headScene();
    }

    void run(BenchReport& report)
    {
        HairRenderSettings settings = settings_;
        settings.mode = HairMode::Reference;
        settings.frames = truthSamples(options_) / 4;
        const HairFrame truth =
            hairTruth(context_, subject_.hair, head_ ? &*head_ : nullptr, subject_.camera, settings,
                      options_.keep ? cacheFolder() : std::filesystem::path());
        double base = 0.0;
        for (const HairMethod& method : hairMethods(truthSamples(options_), networks_,
                                                    context_.device().missingForHalves.empty())) {
            throwIfInterrupted();
            const HairFrame frame = render(settingsOf(method));
            const HairError error = compareHair(frame, truth);
            check(subject_.name + " " + method.name, error);
            const HairFrame moved = nextFrame(method); // timed: the first one builds pipelines
            base = base > 0.0 ? base : error.picture.rmse;
            Json row = {{"name", subject_.name + " " + method.name},
                        {"scene", subject_.name},
                        {"method", method.name},
                        {"series", hairSeries(method.name)},
                        {"rmse", error.picture.rmse},
                        {"rmse_over_4", error.picture.rmse / base},
                        {"psnr_db", error.picture.psnr},
                        {"ssim", error.picture.ssim},
                        {"flip", error.picture.flip},
                        {"coverage_error", error.coverage},
                        {"flicker", hairFlicker(frame, moved)},
                        {"ms", millisecondsOf(moved, "")},
                        {"ms_shadow", millisecondsOf(moved, "shadow")},
                        {"ms_strands", millisecondsOf(moved, "hair strands")},
                        {"ms_coverage", millisecondsOf(moved, "exact coverage")},
                        {"ms_blend",
                         millisecondsOf(moved, "hair cuts") + millisecondsOf(moved, "hair blend")},
                        {"ms_network", networkMilliseconds(moved)},
                        {"ms_composite", millisecondsOf(moved, "composite")}};
            if (method.halves) {
                HairRenderSettings floats = settingsOf(method);
                floats.halves = false;
                row["rmse_from_fp32"] = compareHair(frame, render(floats)).picture.rmse;
            }
            report.add(row);
            if (method.network && pictures_.is_null() && !options_.out.empty())
                pictures_ = savePictures(method.name, frame, truth, error);
        }
    }

    // Of the first network, for the report; null without a folder or a network.
    const Json& pictures() const { return pictures_; }

private:
    Json savePictures(const std::string& method, const HairFrame& frame, const HairFrame& truth,
                      const HairError& error) const
    {
        return savePictureSet(options_.out, "hair_" + subject_.name, subject_.name,
                              method + ": RMSE " + fixed(error.picture.rmse, 4) + ", FLIP " +
                                  fixed(error.picture.flip, 4),
                              frame.radiance, truth.radiance);
    }

    HairRenderSettings settingsOf(const HairMethod& method) const
    {
        HairRenderSettings settings = settings_;
        settings.filter = method.filter;
        settings.frames = method.frames;
        settings.network = method.network;
        settings.lod = method.lod;
        settings.skipTiles = method.skipTiles;
        settings.halves = method.halves;
        return settings;
    }

    HairFrame render(const HairRenderSettings& settings)
    {
        return renderHair(context_, subject_.hair, head_ ? &*head_ : nullptr, subject_.camera,
                          settings);
    }

    // With other noise, a pixel on.
    HairFrame nextFrame(const HairMethod& method)
    {
        HairRenderSettings settings = settingsOf(method);
        settings.frameIndex = method.frames;
        settings.lensShift = {1.0f, 0.0f};
        return render(settings);
    }

    Context& context_;
    const HairBench& options_;
    std::vector<NamedHairNetwork>& networks_;
    const HairStudyCase& subject_;
    HairRenderSettings settings_;
    std::optional<Scene> head_;
    Json pictures_;
};

// The table of the console: what is read one frame at a time.
void print(const Json& rows)
{
    Json some = rows;
    for (Json& row : some) {
        for (const char* key : {"scene", "method", "series"})
            row.erase(key);
    }
    std::fputs(rowsText(some).c_str(), stdout);
}

void describe(BenchReport& report, const Json& pictures)
{
    Json& about = report.about();
    about["facts"] = hairFacts(report.rows());
    for (const Json& fact : about["facts"])
        std::printf("%s: %s\n", fact.value("label", "").c_str(), fact.value("value", "").c_str());
    for (Json& mean : hairMeans(report.rows()))
        report.add(std::move(mean));
    about["columns"] = hairColumns();
    about["plots"] = hairPlots(report.rows());
    about["tables"] = hairTables(report.rows());
    about["pictures"] = pictures;
}

int benchHair(const HairBench& o)
{
    if (truthSamples(o) % 4 != 0)
        throw Error("--spp: " + std::to_string(o.samples) + " is not a multiple of 4");
    Context context = openDevice(o.common.device);
    BenchReport report("bench hair", o.common, context);
    report.about()["settings"]["truth_samples"] = truthSamples(o);
    std::vector<NamedHairNetwork> networks = openHairNetworks(context, o.weights);
    const std::vector<HairStudyCase> cases = heldOutHair(o.mohawk, o.common.quick ? 4000 : 0);
    Progress progress("bench hair", cases.size());
    Json pictures = Json::array();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        progress.update(i);
        if (!report.wants(cases[i].name))
            continue;
        CaseBench bench(context, o, networks, cases[i]);
        bench.run(report);
        report.write(); // so that an interruption leaves what is done
        if (!bench.pictures().is_null())
            pictures.push_back(bench.pictures());
    }
    progress.update(cases.size());
    if (report.rows().empty())
        throw Error("--filter: no frame's name holds '" + o.common.filter + "'");
    print(report.rows());
    describe(report, pictures);
    report.write();
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
    app->add_option("--weights", o->weights,
                    "Of a network, more than once for several widths; default: those built in")
        ->type_name("FILE");
    app->add_option("--spp", o->samples, "Of the truth, a multiple of 4; default: 1024, quick 256")
        ->type_name("N")
        ->check(CLI::Range(4u, 1u << 14));
    app->add_flag("!--no-cache", o->keep, "Draw truths anew and keep none");
    app->add_option("--out", o->out, "Folder for pictures: the first network's, the truth, FLIP")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory);
    app->add_option("--mohawk", o->mohawk, "The sixth frame's file; a groom where it is none")
        ->type_name("FILE");
    addExamples(*app, "  strandlight bench hair --quick --out out/bench --json hair.json\n"
                      "  strandlight bench hair --filter ponytail");
    return {app, [o] { return benchHair(*o); }};
}

} // namespace strandlight::cli
