#include "passes/gi_measure.hpp"

#include <algorithm>
#include <optional>

#include "engine/base/error.hpp"
#include "engine/base/image_metrics.hpp"
#include "engine/base/progress.hpp"
#include "passes/gi_truth.hpp"
#include "passes/sgl_lobe.hpp"

namespace strandlight {
namespace {

// With the masks that say which lobes a tile keeps.
double bytesPerTexel(const GiChoice& choice, const GiCapture& capture, const LightFieldModel& model)
{
    if (!isFree(choice))
        return model.bytesPerTexel;
    constexpr double kBytesPerLobe[] = {28.0, 12.0, 8.0};
    double bytes = kBytesPerLobe[std::size_t(choice.storage)] * double(model.lobes->keptCount());
    if (!model.lobes->kept.empty())
        bytes +=
            double(sglMaskBytes(choice.lobes)) * lobeTiles(capture.atlas, choice.lobeTile).count;
    return bytes / capture.problem.texelCount();
}

double shadingMilliseconds(const FrameResult& frame)
{
    double sum = 0.0;
    for (const PassTiming& timing : frame.timings)
        if (timing.pass.starts_with("sg "))
            sum += timing.milliseconds;
    return sum;
}

} // namespace

struct GiMeasure::State
{
    State(Context& useContext, const Scene& useScene, const GiMeasureSettings& useSettings)
        : context(useContext), scene(useScene), settings(useSettings),
          device(uploadScene(useContext, useScene)),
          camera(useSettings.camera ? *useSettings.camera : defaultCamera(useScene)),
          fits(useContext, useScene, device, useSettings.fit)
    {
    }

    Context& context;
    const Scene& scene;
    GiMeasureSettings settings;
    GpuScene device;
    Camera camera;
    GiFits fits;
    CpuImage truth;
    FrameResult frame;
    BakeSavings savings;

    void draw(const GiChoice& choice, const SgField& lobes, GiRow& row);
};

void GiMeasure::State::draw(const GiChoice& choice, const SgField& lobes, GiRow& row)
{
    const GiCapture& capture = fits.captured(choice);
    SgBake bake;
    bake.atlas = capture.atlas;
    bake.radiance = lobes;
    bake.environment = capture.environment;
    savings = bakeSavings(bake);
    RenderSettings wanted;
    wanted.width = settings.width;
    wanted.height = settings.height;
    wanted.specular = choice.specular;
    wanted.diffuse = choice.diffuse;
    frame = renderFrame(context, scene, device, bake, camera, wanted);
    const ImageComparison error = compareImages(frame.radiance, truth);
    if (error.nonFinite > 0) // no time of a wrong picture
        throw Error(std::to_string(error.nonFinite) + " pixels of a frame are not finite");
    std::vector<double> milliseconds;
    for (std::uint32_t i = 0; i < settings.frames; ++i) {
        throwIfInterrupted();
        frame = renderFrame(context, scene, device, bake, camera, wanted);
        milliseconds.push_back(shadingMilliseconds(frame));
    }
    const auto middle = milliseconds.begin() + std::ptrdiff_t(milliseconds.size() / 2);
    std::nth_element(milliseconds.begin(), middle, milliseconds.end());
    row.shadingMilliseconds = *middle;
    row.relMse = error.relMse;
    row.flip = error.flip;
    row.ssim = error.ssim;
}

GiMeasure::GiMeasure(Context& context, const Scene& scene, const GiMeasureSettings& settings)
    : state_(std::make_unique<State>(context, scene, settings))
{
    if (settings.frames == 0)
        throw Error("no frame to time");
    state_->truth = truthPicture(context, scene, state_->device, state_->camera,
                                 {.width = settings.width,
                                  .height = settings.height,
                                  .samples = settings.truthSamples,
                                  .bounces = settings.fit.bake.bounces,
                                  .seed = settings.fit.bake.seed + 2},
                                 settings.cache);
}

GiMeasure::~GiMeasure() = default;

GiRow GiMeasure::measure(const std::string& knob, const GiChoice& choice)
{
    const GiCapture& capture = state_->fits.captured(choice);
    const GiBetween& between = state_->fits.between(choice);
    const LightFieldModel& model = state_->fits.fitted(choice);
    GiRow row{.knob = knob, .choice = choice};
    row.texels = capture.problem.texelCount();
    row.bytesPerTexel = bytesPerTexel(choice, capture, model);
    row.captureSeconds = capture.captureSeconds;
    row.fitSeconds = model.seconds;
    row.bakeSeconds = capture.captureSeconds + capture.environmentSeconds + model.seconds;

    std::optional<SgField> lobes;
    if (model.lobes)
        lobes = isFree(choice) ? storedAs(*model.lobes, choice.storage) : *model.lobes;
    const LightFieldModel own =
        isFree(choice) ? freeSgModel(capture.problem, *lobes, "", 0.0) : model;
    row.texelRmse = compareFits(capture.problem, {}, {own}).rows[0].texelRmse;
    // Lobes can be looked at in any direction, the others only in those of their images.
    row.betweenRmse =
        between.rmse(isFree(choice) ? freeSgModel(between.view, *lobes, "", 0.0) : own);
    if (lobes)
        state_->draw(choice, *lobes, row);
    return row;
}

std::vector<GiTracePoint> GiMeasure::trace(const GiChoice& choice)
{
    std::vector<GiTracePoint> points;
    state_->fits.fitted(choice, &points);
    return points;
}

const CpuImage& GiMeasure::truth() const
{
    return state_->truth;
}

const FrameResult& GiMeasure::lastFrame() const
{
    return state_->frame;
}

const BakeSavings& GiMeasure::lastSavings() const
{
    return state_->savings;
}

} // namespace strandlight
