#include "passes/hair_render.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.hpp"
#include "passes/hair_blend.hpp"
#include "passes/hair_counts.hpp"
#include "passes/hair_filter.hpp"
#include "passes/hair_lobe_passes.hpp"
#include "passes/hair_network.hpp"
#include "passes/hair_passes.hpp"

namespace strandlight {
namespace {

void checkSettings(const HairRenderSettings& s)
{
    const auto text = [](double value) { return std::to_string(value); };
    if (s.width == 0 || s.height == 0 || s.width > 8192 || s.height > 8192)
        throw Error("hair: the size " + std::to_string(s.width) + "x" + std::to_string(s.height) +
                    " is not within 1 to 8192 pixels a side");
    if (s.frames == 0)
        throw Error("hair: at least one frame must be rendered");
    if (!(s.alpha >= 0.0f && s.alpha <= 1.0f))
        throw Error("hair: alpha is " + text(s.alpha) + ", it must be in [0, 1]");
    if (!(s.roughness >= 0.05f && s.roughness <= 1.0f))
        throw Error("hair: roughness is " + text(s.roughness) + ", it must be in [0.05, 1]");
    if (!(std::abs(s.tiltDegrees) <= 10.0f))
        throw Error("hair: tilt is " + text(s.tiltDegrees) + " degrees, it must be in [-10, 10]");
    if (s.shadows && (s.shadowSize < 16 || s.shadowSize > 8192))
        throw Error("hair: a shadow map of " + std::to_string(s.shadowSize) +
                    " texels a side, it must be 16 to 8192");
    if (!(glm::length(s.keyDirection) > 0.0f))
        throw Error("hair: the key light needs a direction");
    if (s.filter == HairFilter::UNet && s.network == nullptr)
        throw Error("hair: the filter is a network, but no network is given");
    if (s.filter == HairFilter::UNet && (s.frames > 1 || s.mode == HairMode::Reference))
        throw Error("hair: the network filters the four samples of one frame, not more");
    if (s.background && (s.background->width != s.width || s.background->height != s.height))
        throw Error("hair: the background is " + std::to_string(s.background->width) + "x" +
                    std::to_string(s.background->height) + ", the picture " +
                    std::to_string(s.width) + "x" + std::to_string(s.height));
}

CpuImage backgroundPicture(const HairRenderSettings& settings)
{
    if (settings.background)
        return *settings.background;
    return CpuImage(settings.width, settings.height, glm::vec4(settings.backgroundColor, 1.0f));
}

// Hair over what is behind it. `behind` is premultiplied by the samples that showed it.
void composite(HairFrame& frame, const CpuImage& behind, const HairRenderSettings& settings)
{
    frame.radiance = CpuImage(settings.width, settings.height);
    for (std::size_t i = 0; i < frame.hair.pixels.size(); ++i) {
        glm::vec4& hair = frame.hair.pixels[i];
        const glm::vec4& open = behind.pixels[i];
        const float noisy = hair.w;
        if (settings.filter == HairFilter::Coverage && noisy < 1.0f) {
            hair *= (1.0f - frame.exactTransmittance.pixels[i].x) / (1.0f - noisy);
            hair.w = frame.exactTransmittance.pixels[i].x;
        }
        glm::vec3 back(0.0f);
        if (settings.background)
            back = glm::vec3(settings.background->pixels[i]);
        else if (open.w > 0.0f)
            back = glm::vec3(open) / open.w;
        frame.radiance.pixels[i] = glm::vec4(glm::vec3(hair) + hair.w * back, 1.0f);
    }
}

// Shading once, then every frame's samples into the sums.
class FrameMaker
{
public:
    FrameMaker(Context& context, const HairStrands& hair, const Scene* opaque, const Camera& camera,
               const HairRenderSettings& settings, HairFrame& out)
        : context_(context), settings_(settings), out_(out),
          lights_(hairLights(hair, opaque, settings))
    {
        out.lod = settings.lod;
        if (out.lod == 0)
            out.lod = settings.mode == HairMode::Reference
                          ? 1
                          : automaticHairLod(hair, camera, settings.height);
        buffers_ = uploadHair(context, hair, opaque, lights_, out.lod);
        if (settings.distant)
            uploadHairLobes(context, buffers_, hair, opaque, *settings.distant, settings);
        out.drawnStrands = buffers_.strandCount;
        out.drawnSegments = buffers_.segmentCount;
        view_.viewProjection = cameraViewProjection(camera, settings.width, settings.height,
                                                    hairDepthRange(hair, opaque, camera));
        view_.eye = camera.eye;
        view_.width = settings.width;
        view_.height = settings.height;
        view_.alpha = settings.alpha;
        view_.jitter = settings.lensShift;
        picture_ = {settings.width, settings.height, 1, Format::RGBA32F, 1};
        depth_ = hairDepthScale(hair, camera);
        planShadows(hair);
    }

    void shade()
    {
        RenderGraph graph(context_);
        graph.setTimings(Timings::Passes);
        const BufferId lit =
            addHairShadingPasses(graph, buffers_, lights_, shadowed_, view_, settings_);
        if (settings_.distant)
            addHairLobePasses(graph, buffers_, lit, lights_.empty(), *settings_.distant, view_,
                              settings_);
        const bool wanted = settings_.exactCoverage || settings_.filter == HairFilter::Coverage;
        const bool later = // in a graph of their own
            settings_.filter == HairFilter::UNet || settings_.filter == HairFilter::Blend;
        if (!wanted || later) {
            if (!later)
                out_.skipped.push_back("hair exact coverage: not asked for");
            graph.run();
        } else {
            const ImageId exact = addHairCoveragePass(graph, buffers_, view_);
            graph.output(exact);
            graph.run();
            out_.exactTransmittance = graph.read(exact);
        }
        addHairTimings(out_.timings, graph.timings());
    }

    void averageFrames()
    {
        Image hair(context_, picture_, "hair sum");
        Image behind(context_, picture_, "behind sum");
        HairView view = view_;
        view.trueWidth = settings_.mode == HairMode::Reference;
        for (std::uint32_t i = 0; i < settings_.frames; ++i) {
            view.frame = settings_.frameIndex + i;
            view.jitter =
                view_.jitter + (settings_.frames > 1 ? hairFrameJitter(i) : glm::vec2(0.0f));
            RenderGraph graph(context_);
            graph.setTimings(Timings::Passes);
            const HairSampleIds samples = addHairStrandsPass(
                graph, buffers_, graph.importBuffer(buffers_.shaded), view, settings_,
                std::uint32_t(lights_.size()), settings_.background == nullptr, false);
            addHairResolvePass(graph, samples, {graph.importImage(hair), graph.importImage(behind)},
                               1.0f / float(settings_.frames),
                               settings_.filter == HairFilter::None ? 1u : 4u);
            graph.run();
            addHairTimings(out_.timings, graph.timings());
        }
        out_.hair = hair.download();
        composite(out_, behind.download(), settings_);
    }

    // All strands, without a network.
    void blendFrame()
    {
        Image radiance(context_, picture_, "hair over background");
        RenderGraph graph(context_);
        graph.setTimings(Timings::Passes);
        const ImageId blended = addBlended(graph).image;
        addBackground(graph, radiance);
        graph.output(blended);
        graph.run();
        addHairTimings(out_.timings, graph.timings());
        out_.hair = graph.read(blended);
        out_.radiance = radiance.download();
        keepTransmittance(out_.hair);
        for (std::size_t i = 0; i < out_.hair.pixels.size(); ++i) {
            const glm::vec4& hair = out_.hair.pixels[i];
            glm::vec4& pixel = out_.radiance.pixels[i];
            pixel = glm::vec4(glm::vec3(hair) + hair.w * glm::vec3(pixel), 1.0f);
        }
    }

    // One frame through the network.
    void filterFrame()
    {
        Image filtered(context_, picture_, "filtered hair");
        Image radiance(context_, picture_, "hair over background");
        RenderGraph graph(context_);
        graph.setTimings(Timings::Passes);
        const Blended blended = addBlended(graph);
        const HairComposite over{graph.importImage(filtered), addBackground(graph, radiance)};
        const ParameterIds weights(graph, settings_.network->parameters);
        std::optional<HalfGuard> guard;
        if (settings_.halves)
            guard.emplace(graph);
        const HairComposite done = addHairFilterPasses(
            graph, settings_.network->net, weights, {blended.samples, blended.image, depth_}, over,
            {.skipTiles = settings_.skipTiles,
             .fuseFetch = settings_.fuseFetch,
             .halves = guard ? &*guard : nullptr});
        if (guard)
            guard->output(graph);
        graph.output(blended.image);
        for (const LayerTiles& layer : done.tiles)
            graph.output(layer.arguments);
        graph.run();
        if (guard)
            guard->check(graph);
        addHairTimings(out_.timings, graph.timings());
        out_.tiles = countHairTiles(graph, done.tiles);
        keepTransmittance(graph.read(blended.image));
        out_.radiance = radiance.download();
        out_.hair = filtered.download();
        for (glm::vec4& pixel : out_.hair.pixels)
            pixel.w = 1.0f - pixel.w;
    }

private:
    struct Blended
    {
        HairSampleIds samples;
        ImageId image;
    };
    Blended addBlended(RenderGraph& graph)
    {
        HairView view = view_;
        view.frame = settings_.frameIndex;
        const BufferId shaded = graph.importBuffer(buffers_.shaded);
        const HairSampleIds samples = addHairStrandsPass(
            graph, buffers_, shaded, view, settings_, std::uint32_t(lights_.size()), false, true);
        return {samples,
                addHairBlendPass(graph, buffers_, shaded, view, addHairCutsPass(graph, samples))};
    }

    ImageId addBackground(RenderGraph& graph, Image& radiance)
    {
        if (settings_.background) {
            radiance.upload(*settings_.background);
            return graph.importImage(radiance);
        }
        return addHairBackdropPass(graph, buffers_, view_, settings_, std::uint32_t(lights_.size()),
                                   graph.importImage(radiance));
    }

    void keepTransmittance(const CpuImage& blended)
    {
        out_.exactTransmittance = CpuImage(blended.width, blended.height);
        for (std::size_t i = 0; i < blended.pixels.size(); ++i)
            out_.exactTransmittance.pixels[i].x = blended.pixels[i].w;
    }

    void planShadows(const HairStrands& hair)
    {
        for (std::size_t i = 0; i < lights_.size(); ++i) {
            const bool possible = hairLightCastsShadow(hair, lights_[i]);
            shadowed_.push_back(settings_.shadows && possible);
            if (!shadowed_.back())
                out_.skipped.push_back("hair shadow " + std::to_string(i) + ": " +
                                       (possible ? "switched off" : "the light is in the hair"));
        }
    }

    Context& context_;
    const HairRenderSettings& settings_;
    HairFrame& out_;
    std::vector<gpu::HairLight> lights_;
    std::vector<bool> shadowed_;
    HairBuffers buffers_;
    HairView view_;
    HairDepthScale depth_;
    ImageDesc picture_;
};

} // namespace

// Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018 (R2)
glm::vec2 hairFrameJitter(std::uint32_t frame)
{
    const double x = 0.5 + 0.7548776662466927 * double(frame);
    const double y = 0.5 + 0.5698402909980532 * double(frame);
    return {float(0.5 * (x - std::floor(x)) - 0.25), float(0.5 * (y - std::floor(y)) - 0.25)};
}

HairFrame renderHair(Context& context, const HairStrands& hair, const Scene* opaque,
                     const Camera& camera, const HairRenderSettings& settings)
{
    checkSettings(settings);
    HairFrame frame;
    if (hair.points.empty()) {
        frame.radiance = backgroundPicture(settings);
        frame.hair = CpuImage(settings.width, settings.height, {0.0f, 0.0f, 0.0f, 1.0f});
        frame.skipped.push_back("hair: there is no strand");
        return frame;
    }
    checkHair(hair);
    FrameMaker maker(context, hair, opaque, camera, settings, frame);
    maker.shade();
    if (settings.filter == HairFilter::UNet)
        maker.filterFrame();
    else if (settings.filter == HairFilter::Blend)
        maker.blendFrame();
    else
        maker.averageFrames();
    countHairBlocks(frame);
    return frame;
}

} // namespace strandlight
