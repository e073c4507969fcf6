// strandlight compare: how far a picture is from its truth.
#include <cmath>
#include <cstdio>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/flip.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/image_metrics.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    std::string picture;
    std::string reference;
    std::string heatmap;
    float exposure = 0.0f;
    std::string json;
};

double meanOf(const glm::dvec3& color)
{
    return (color.r + color.g + color.b) / 3.0;
}

double blockPercent(const ImageComparison& result)
{
    return 100.0 * result.blockRmse / meanOf(result.referenceMean);
}

// An infinite PSNR (equal pictures) and a ratio to a black truth have no JSON number: null.
Json number(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json describe(const Options& o, const CpuImage& image, const ImageComparison& r)
{
    Json json = describeRun("compare", nullptr);
    json["settings"] = {{"picture", o.picture},
                        {"reference", o.reference},
                        {"width", image.width},
                        {"height", image.height},
                        {"exposure", o.exposure}};
    json["result"] = {
        {"rmse", number(r.rmse)},
        {"relmse", number(r.relMse)},
        {"psnr_db", number(r.psnr)},
        {"ssim", number(r.ssim)},
        {"flip", number(r.flip)},
        {"mean", {number(r.mean.r), number(r.mean.g), number(r.mean.b)}},
        {"reference_mean",
         {number(r.referenceMean.r), number(r.referenceMean.g), number(r.referenceMean.b)}},
        {"block_rmse", number(r.blockRmse)},
        {"block_rmse_percent", number(blockPercent(r))},
        {"non_finite", r.nonFinite},
        {"reference_non_finite", r.referenceNonFinite}};
    return json;
}

void print(const ImageComparison& r)
{
    std::printf("RMSE        %.6g\n", r.rmse);
    std::printf("relMSE      %.6g\n", r.relMse);
    std::printf("PSNR        %.2f dB\n", r.psnr);
    std::printf("SSIM        %.4f\n", r.ssim);
    std::printf("FLIP        %.4f\n", r.flip);
    std::printf("block RMSE  %.6g, %.2f %% of the reference's mean (8x8 pixels)\n", r.blockRmse,
                blockPercent(r));
    static const char* const kChannels[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        std::printf("mean %s      %.6g, reference %.6g, %+.2f %%\n", kChannels[c], r.mean[c],
                    r.referenceMean[c], 100.0 * (r.mean[c] / r.referenceMean[c] - 1.0));
    if (r.nonFinite + r.referenceNonFinite > 0)
        std::printf("left out    %llu pixels that are not finite, %llu of the reference\n",
                    static_cast<unsigned long long>(r.nonFinite),
                    static_cast<unsigned long long>(r.referenceNonFinite));
}

int run(const Options& o)
{
    requireOutput(o.heatmap, {".png"});
    requireOutput(o.json, {".json"});
    const CpuImage picture = loadImage(o.picture);
    const CpuImage reference = loadImage(o.reference);
    if (picture.width != reference.width || picture.height != reference.height)
        throw FileError(o.picture, "",
                        "is " + std::to_string(picture.width) + "x" +
                            std::to_string(picture.height) + " pixels, " + o.reference + " is " +
                            std::to_string(reference.width) + "x" +
                            std::to_string(reference.height));
    CompareSettings settings;
    settings.exposureStops = o.exposure;
    const ImageComparison result = compareImages(picture, reference, settings);
    if (!o.heatmap.empty())
        savePng(o.heatmap, heatmap(computeFlip(displayImage(picture, o.exposure),
                                               displayImage(reference, o.exposure))));
    print(result);
    writeJson(o.json, describe(o, picture, result));
    return 0;
}

} // namespace

Command addCompare(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("compare", "Measure a picture against its truth");
    const auto o = std::make_shared<Options>();
    app->add_option("A", o->picture, "The picture: .exr, .hdr, .png or .jpg")
        ->required()
        ->type_name("");
    app->add_option("B", o->reference, "Its truth")->required()->type_name("");
    app->add_option("--heatmap", o->heatmap, "Picture of the FLIP error")->type_name("FILE.png");
    app->add_option("--exposure", o->exposure, "Stops, for PSNR, SSIM, FLIP and the heat map")
        ->type_name("STOPS")
        ->capture_default_str()
        ->check(CLI::Range(-40.0, 40.0));
    addJsonOption(*app, o->json);
    addExamples(*app, "  strandlight compare room.exr truth.exr --heatmap difference.png\n"
                      "RMSE, relMSE, block RMSE and means are of linear radiance; PSNR, SSIM and "
                      "FLIP of the exposed picture.");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
