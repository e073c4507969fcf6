#include "passes/hair_training_data.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "engine/scene/hair_head.hpp"
#include "passes/hair_blend.hpp"
#include "shaders/shared/rng.h"

namespace strandlight {
namespace {

constexpr std::uint32_t kShadowNoises = 2;
constexpr std::uint32_t kMostLod = 4;
constexpr float kLodWidth = 0.15f; // pixels

// Segments that the camera may see, of every lod-th strand.
struct DrawSet
{
    Buffer segments;
    std::uint32_t segmentCount = 0;
    float widthScale = 1.0f;
};

bool outside(const glm::vec4& a, const glm::vec4& b)
{
    constexpr float kMargin = 1.1f; // strands have a width, frames a jitter
    for (int axis = 0; axis < 2; ++axis)
        if ((a[axis] > kMargin * a.w && b[axis] > kMargin * b.w) ||
            (a[axis] < -kMargin * a.w && b[axis] < -kMargin * b.w))
            return true;
    return a.w <= 0.0f && b.w <= 0.0f;
}

DrawSet visibleSegments(Context& context, const HairStrands& hair, const glm::mat4& viewProjection,
                        std::uint32_t lod)
{
    std::vector<glm::uvec2> segments;
    const auto clip = [&](std::uint32_t p) {
        return viewProjection * glm::vec4(hair.points[p], 1.0f);
    };
    for (std::uint32_t strand = 0; strand < hair.strandCount(); strand += lod)
        for (std::uint32_t p = hair.firstPoint[strand]; p + 1 < hair.firstPoint[strand + 1]; ++p)
            if (!outside(clip(p), clip(p + 1)))
                segments.emplace_back(p, strand);
    return {Buffer::from(context, segments, "visible segments"), std::uint32_t(segments.size()),
            float(lod)};
}

void swapSegments(HairBuffers& buffers, DrawSet& set)
{
    std::swap(buffers.segments, set.segments);
    std::swap(buffers.segmentCount, set.segmentCount);
    std::swap(buffers.widthScale, set.widthScale);
}

class FrameMaker
{
public:
    FrameMaker(Context& context, const HairTrainingLook& look, const HairTrainingSettings& settings)
        : context_(context), settings_(settings), opaque_(look.head ? headScene() : Scene{})
    {
        opaque_.lights = look.lights;
        GroomSettings groom = look.groom;
        groom.strands = std::max(1u, std::uint32_t(float(groom.strands) * settings.strandShare));
        groom.radiusMetres /= std::sqrt(settings.strandShare);
        hair_ = makeGroom(look.style, groom);
        camera_ = hairTrainingCamera(look, hair_);
        render_.width = render_.height = settings.size;
        render_.roughness = look.roughness;
        render_.ambient = look.ambient;
        lights_ = hairLights(hair_, &opaque_, render_);
        for (const gpu::HairLight& light : lights_)
            shadowed_.push_back(hairLightCastsShadow(hair_, light));
        buffers_ = uploadHair(context, hair_, &opaque_, lights_, 1);
        view_.viewProjection = cameraViewProjection(camera_, settings.size, settings.size,
                                                    hairDepthRange(hair_, &opaque_, camera_));
        view_.eye = camera_.eye;
        view_.width = view_.height = settings.size;
        full_ = visibleSegments(context, hair_, view_.viewProjection, 1);
        thin_ = visibleSegments(context, hair_, view_.viewProjection, lod());
    }

    HairTrainingFrame make(std::uint32_t noise, bool heldOut)
    {
        frame_.size = settings_.size;
        frame_.repeats = settings_.repeats;
        frame_.hasAverages = heldOut;
        frame_.planes.resize(frame_.planeCount() * settings_.size * settings_.size);
        Sum target(context_, settings_.size);
        for (std::uint32_t i = 0; i < kShadowNoises; ++i) {
            render_.frameIndex = gpu::hashPcg(noise + i) >> 8;
            shade();
            for (std::uint32_t r = i; r < settings_.repeats; r += kShadowNoises)
                makeRepeat(r);
            if (heldOut && i == 0)
                makeAverages();
            const std::uint32_t frames = settings_.targetSamples / 4;
            for (std::uint32_t k = i; k < frames; k += kShadowNoises)
                addTruth(target, k, 1.0f / float(frames));
        }
        store(frame_.targetPlane(), target.hair.download(), 4);
        store(frame_.targetPlane() + 4, target.illumination.download(), 1);
        return std::move(frame_);
    }

private:
    struct Sum
    {
        Sum(Context& context, std::uint32_t size)
            : hair(context, {size, size, 1, Format::RGBA32F, 1}, "hair sum"),
              behind(context, {size, size, 1, Format::RGBA32F, 1}, "behind sum"),
              illumination(context, {size, size, 1, Format::R32F, 1}, "illumination sum")
        {
        }
        Image hair, behind, illumination;
    };

    // By the width of strands in the picture, as automaticHairLod does, whatever their number.
    std::uint32_t lod() const
    {
        const float pixels = float(settings_.size) /
                             std::tan(glm::radians(0.5f * camera_.verticalFovDegrees)) /
                             glm::length(camera_.eye - camera_.target);
        return std::clamp(std::uint32_t(kLodWidth / (hair_.radii.front() * pixels)), 1u, kMostLod);
    }

    void shade()
    {
        RenderGraph graph(context_);
        addHairShadingPasses(graph, buffers_, lights_, shadowed_, view_, render_);
        graph.run();
    }

    HairSampleIds strands(RenderGraph& graph, const HairView& view, bool features)
    {
        return addHairStrandsPass(graph, buffers_, graph.importBuffer(buffers_.shaded), view,
                                  render_, std::uint32_t(lights_.size()), false, features);
    }

    void makeRepeat(std::uint32_t repeat)
    {
        throwIfInterrupted();
        DrawSet& set = repeat / kShadowNoises % 2 == 0 ? full_ : thin_;
        swapSegments(buffers_, set);
        HairView view = view_;
        view.frame = render_.frameIndex + 64u + repeat;
        Sum sum(context_, settings_.size);
        RenderGraph graph(context_);
        const HairSampleIds samples = strands(graph, view, true);
        const TensorDesc desc = hairInputDesc(settings_.size, settings_.size);
        const HairDepthScale depth = hairDepthScale(hair_, camera_);
        const ImageId blended =
            addHairBlendPass(graph, buffers_, graph.importBuffer(buffers_.shaded), view,
                             addHairCutsPass(graph, samples));
        const BufferId planes = addHairInputPass(graph, samples, blended, depth,
                                                 createTensor(graph, "hair network input", desc))
                                    .buffer;
        addHairResolvePass(graph, samples,
                           {graph.importImage(sum.hair), graph.importImage(sum.behind)}, 1.0f);
        graph.output(planes);
        graph.output(blended);
        graph.run();
        const std::size_t first = frame_.repeatPlane(repeat) * pixels();
        const std::vector<float> values = graph.read<float>(planes);
        std::transform(values.begin(), values.end(), frame_.planes.begin() + std::ptrdiff_t(first),
                       [](float value) { return glm::packHalf1x16(value); });
        store(frame_.repeatPlane(repeat) + kHairBlendedPlane, graph.read(blended), 3);
        store(frame_.repeatPlane(repeat) + kHairMeanPlane, sum.hair.download(), 3);
        swapSegments(buffers_, set);
    }

    // As `hair render --samples` averages them.
    void makeAverages()
    {
        swapSegments(buffers_, full_);
        for (std::uint32_t i = 0; i < kHairAverageSamples.size(); ++i) {
            const std::uint32_t frames = kHairAverageSamples[i] / 4;
            Sum sum(context_, settings_.size);
            for (std::uint32_t k = 0; k < frames; ++k) {
                HairView view = view_;
                view.frame = render_.frameIndex + 128u + k;
                view.jitter = hairFrameJitter(k);
                addFrame(sum, view, 1.0f / float(frames), false);
            }
            store(frame_.averagePlane(i), sum.hair.download(), kHairAveragePlanes);
        }
        swapSegments(buffers_, full_);
    }

    void addTruth(Sum& sum, std::uint32_t k, float weight)
    {
        swapSegments(buffers_, full_);
        HairView view = view_;
        view.trueWidth = true;
        view.frame = render_.frameIndex + 1024u + k;
        view.jitter = hairFrameJitter(k);
        addFrame(sum, view, weight, true);
        swapSegments(buffers_, full_);
    }

    void addFrame(Sum& sum, const HairView& view, float weight, bool illumination)
    {
        throwIfInterrupted();
        RenderGraph graph(context_);
        const HairSampleIds samples = strands(graph, view, illumination);
        addHairResolvePass(graph, samples,
                           {graph.importImage(sum.hair), graph.importImage(sum.behind)}, weight);
        if (illumination)
            addHairIlluminationPass(graph, samples, graph.importImage(sum.illumination), weight);
        graph.run();
    }

    void store(std::size_t plane, const CpuImage& image, std::uint32_t channels)
    {
        for (std::uint32_t c = 0; c < channels; ++c)
            for (std::size_t i = 0; i < image.pixels.size(); ++i)
                frame_.planes[(plane + c) * pixels() + i] =
                    glm::packHalf1x16(image.pixels[i][int(c)]);
    }

    std::size_t pixels() const { return std::size_t(settings_.size) * settings_.size; }

    Context& context_;
    HairTrainingSettings settings_;
    Scene opaque_;
    HairStrands hair_;
    Camera camera_;
    HairRenderSettings render_;
    std::vector<gpu::HairLight> lights_;
    std::vector<bool> shadowed_;
    HairBuffers buffers_; // draws all segments: shadows fall from outside of the view
    HairView view_;
    DrawSet full_, thin_;
    HairTrainingFrame frame_;
};

} // namespace

std::size_t HairTrainingFrame::planeCount() const
{
    const std::size_t averages = hasAverages ? kHairAverageSamples.size() * kHairAveragePlanes : 0;
    return targetPlane() + kHairTargetPlanes + averages;
}

float HairTrainingFrame::at(std::size_t plane, std::uint32_t x, std::uint32_t y) const
{
    return glm::unpackHalf1x16(planes[(plane * size + y) * size + x]);
}

void checkHairTrainingSettings(const HairTrainingSettings& s)
{
    const auto refuse = [](const std::string& reason) { throw Error("hair training: " + reason); };
    if (s.size < 8 || s.size > 2048 || s.size % 8 != 0)
        refuse("a frame of " + std::to_string(s.size) + " pixels, it must be a multiple of 8");
    if (s.repeats == 0 || s.repeats % kShadowNoises != 0)
        refuse(std::to_string(s.repeats) + " noises, it must be a multiple of 2");
    if (s.targetSamples == 0 || s.targetSamples % (4 * kShadowNoises) != 0)
        refuse(std::to_string(s.targetSamples) + " target samples, it must be a multiple of 8");
    if (!(s.strandShare > 0.0f && s.strandShare <= 1.0f))
        refuse("a share of strands of " + std::to_string(s.strandShare));
}

HairTrainingFrame makeHairTrainingFrame(Context& context, const HairTrainingLook& look,
                                        const HairTrainingSettings& settings, bool heldOut)
{
    checkHairTrainingSettings(settings);
    return FrameMaker(context, look, settings).make(look.groom.seed, heldOut);
}

} // namespace strandlight
