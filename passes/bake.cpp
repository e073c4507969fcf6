#include "passes/bake.hpp"

#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/gpu_scene.hpp"
#include "passes/bake_checkpoint.hpp"
#include "passes/fit_report.hpp"
#include "passes/light_field_baselines.hpp"
#include "passes/lightfield_capture.hpp"
#include "passes/sg_energy.hpp"
#include "passes/sg_fit.hpp"

namespace strandlight {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSecondsBetweenSaves = 15.0;  // what a kill -9 may cost at most
constexpr std::uint64_t kStoredLobeBytes = 14; // fp16: oct axis 4, ln sharpness 2, amplitude 8

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// FNV-1a over raw bytes: names an input, protects nothing.
class Hash
{
public:
    void bytes(const void* data, std::size_t count)
    {
        const auto* raw = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < count; ++i)
            value_ = (value_ ^ raw[i]) * 0x100000001B3ull;
    }
    template <class T> void value(const T& v) { bytes(&v, sizeof(T)); }
    std::uint64_t result() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325ull;
};

// Everything besides the geometry that changes what a bake computes.
std::uint64_t hashSettings(const Scene& scene, const BakeSettings& s)
{
    Hash hash;
    hash.value(hashGeometry(scene));
    hash.value(hashEnvironment(scene));
    for (const Material& material : scene.materials)
        for (const float v :
             {material.baseColor.x, material.baseColor.y, material.baseColor.z, material.metallic,
              material.roughness, material.specular, material.emissive.x, material.emissive.y,
              material.emissive.z, material.alphaCutoff, material.normalScale})
            hash.value(v);
    for (const Texture& texture : scene.textures)
        hash.bytes(texture.rgba.data(), texture.rgba.size());
    for (const PunctualLight& light : scene.lights)
        for (const glm::vec3& v : {light.position, light.direction, light.intensity})
            hash.value(v);
    for (const std::uint32_t v :
         {s.atlasResolution, s.lightfieldSize, s.lobes, s.environmentLobes, s.samplesPerDirection,
          s.bounces, s.steps, s.seed, std::uint32_t(s.fit)})
        hash.value(v);
    return hash.result();
}

FitSettings fitSettings(const BakeSettings& settings, LightSet light)
{
    FitSettings fit;
    fit.mode = settings.fit;
    fit.lobes = light == LightSet::Radiance ? settings.lobes : settings.environmentLobes;
    fit.steps = settings.steps;
    fit.seed = settings.seed;
    return fit;
}

// Keeps the checkpoint file up to date; does nothing without a path.
class Saver
{
public:
    Saver(const BakeSettings& settings, std::uint64_t hash) : path_(settings.checkpoint)
    {
        if (settings.resume && !path_.empty() && std::filesystem::exists(path_))
            state = loadCheckpoint(path_, hash);
        state.settingsHash = hash;
    }
    void save() const
    {
        if (!path_.empty())
            saveCheckpoint(path_, state);
    }
    bool active() const { return !path_.empty(); }

    BakeCheckpoint state;

private:
    std::filesystem::path path_;
};

Lightfield capture(Context& context, const Scene& scene, GpuScene& device, const Atlas& atlas,
                   const BakeSettings& settings, Saver& saver)
{
    CaptureSettings wanted;
    wanted.size = settings.lightfieldSize;
    wanted.samplesPerDirection = settings.samplesPerDirection;
    wanted.bounces = settings.bounces;
    wanted.seed = settings.seed;
    LightfieldCapture work(context, device, capturePoints(scene, atlas), wanted);
    if (!saver.state.capture.empty())
        work.restore(saver.state.capture);

    Progress progress("capture", work.texelCount());
    Clock::time_point lastSave = Clock::now();
    try {
        while (!work.step()) {
            progress.update(work.completedTexels());
            if (saver.active() && secondsSince(lastSave) > kSecondsBetweenSaves) {
                saver.state.capture = work.save();
                saver.save();
                lastSave = Clock::now();
            }
        }
    } catch (const Interrupted&) {
        saver.state.capture = work.save();
        saver.save();
        throw;
    }
    progress.update(work.texelCount());
    if (saver.active()) {
        saver.state.capture = work.save();
        saver.save();
    }
    return work.finish();
}

SgField fit(Context& context, const FitProblem& problem, const FitSettings& settings,
            std::optional<FitState>& progress, Saver& saver)
{
    const std::optional<FitState> resumed = progress;
    FitCheckpoint checkpoint;
    checkpoint.resume = resumed ? &*resumed : nullptr;
    checkpoint.secondsBetweenSaves = kSecondsBetweenSaves;
    if (saver.active())
        checkpoint.save = [&](const FitState& state) {
            progress = state;
            saver.save();
        };
    SgField field = fitLobes(context, problem, settings, nullptr, &checkpoint);
    matchIrradiance(problem, field);
    return field;
}

double rmseAtTexels(const FitProblem& problem, const SgField& field)
{
    const FitReport report =
        compareFits(problem, FitProbes{}, {freeSgModel(problem, field, "bake", 0.0)}, 1024);
    return report.rows.empty() ? 0.0 : report.rows[0].texelRmse;
}

} // namespace

SgBake bakeScene(Context& context, const Scene& scene, const BakeSettings& settings,
                 BakeStatistics* statistics)
{
    BakeStatistics numbers;
    if (scene.triangles.empty())
        throw Error("the scene has no triangles: there is nothing to bake");

    // Atlas
    Clock::time_point start = Clock::now();
    SgBake bake;
    bake.atlas = buildAtlas(scene, {.resolution = settings.atlasResolution});
    numbers.atlasSeconds = secondsSince(start);
    numbers.texels = std::uint32_t(bake.atlas.texels.size());
    numbers.emptyTexels = settings.atlasResolution * settings.atlasResolution - numbers.texels;

    // Capture
    Saver saver(settings, hashSettings(scene, settings));
    start = Clock::now();
    GpuScene device = uploadScene(context, scene);
    CpuLightfield images;
    {
        const Lightfield field = capture(context, scene, device, bake.atlas, settings, saver);
        images = downloadLightfield(
            field); // the device's copy goes: the fit lays the images out for itself
    }
    numbers.captureSeconds = secondsSince(start);
    for (const std::uint8_t valid : images.valid)
        numbers.skippedTexels += valid == 0;

    // Lobes of the light that the scene sends back
    start = Clock::now();
    {
        const FitSettings wanted = fitSettings(settings, LightSet::Radiance);
        const FitProblem problem = buildFitProblem(bake.atlas, images, LightSet::Radiance, wanted);
        bake.radiance = saver.state.radiance
                            ? *saver.state.radiance
                            : fit(context, problem, wanted, saver.state.radianceFit, saver);
        numbers.radianceRmse = rmseAtTexels(problem, bake.radiance);
    }
    // Lobes of the distant environment, as far as it is seen
    if (!images.environment.empty()) {
        saver.state.radiance = bake.radiance;
        saver.state.radianceFit.reset();
        saver.save();
        const FitSettings wanted = fitSettings(settings, LightSet::Environment);
        const FitProblem problem =
            buildFitProblem(bake.atlas, images, LightSet::Environment, wanted);
        bake.environment = fit(context, problem, wanted, saver.state.environmentFit, saver);
        numbers.environmentRmse = rmseAtTexels(problem, *bake.environment);
    }
    numbers.fitSeconds = secondsSince(start);

    BakeInfo& info = bake.info;
    info.scene = scene.name;
    info.fitMode = toString(settings.fit);
    info.geometryHash = hashGeometry(scene);
    info.environmentHash = hashEnvironment(scene);
    info.lightfieldSize = settings.lightfieldSize;
    info.samplesPerDirection = settings.samplesPerDirection;
    info.bounces = settings.bounces;
    info.steps = settings.steps;
    info.seed = settings.seed;
    info.rmse = float(numbers.radianceRmse);
    numbers.bytesPerTexel =
        kStoredLobeBytes *
        (bake.radiance.lobeCount + (bake.environment ? bake.environment->lobeCount : 0));
    numbers.peakDeviceBytes = context.peakBytesAllocated();
    if (statistics)
        *statistics = numbers;
    return bake;
}

std::uint64_t hashGeometry(const Scene& scene)
{
    Hash hash;
    for (const glm::uvec3& triangle : scene.triangles)
        for (int corner = 0; corner < 3; ++corner)
            hash.value(scene.vertices[triangle[corner]].position);
    return hash.result();
}

std::uint64_t hashEnvironment(const Scene& scene)
{
    Hash hash;
    if (scene.environment) {
        const CpuImage& image = scene.environment->latLong;
        hash.value(image.width);
        hash.bytes(image.pixels.data(), image.pixels.size() * sizeof(glm::vec4));
    }
    return scene.environment ? hash.result() : 0;
}

} // namespace strandlight
