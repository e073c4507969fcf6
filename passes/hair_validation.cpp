#include "passes/hair_validation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/assert.hpp"

namespace strandlight {
namespace {

constexpr glm::vec3 kLuminance{0.2126f, 0.7152f, 0.0722f};

struct Filtered
{
    double loss;
    CpuImage picture;
};

// B c / luminance(c) + T behind; where no strand can be (exact T = 1), what is behind.
CpuImage composite(std::span<const float> y, std::span<const float> color, const HairBatch& batch)
{
    const std::size_t pixels = std::size_t(batch.size) * batch.size;
    CpuImage picture(batch.size, batch.size);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float blended = batch.input[gpu::kHairInputBlended * pixels + i];
        const float before = std::expm1(blended);
        const float brightness =
            std::clamp(std::expm1(blended + y[i]), gpu::kHairLeastBrightness * before,
                       gpu::kHairMostBrightness * before);
        const float exact = batch.input[gpu::kHairInputExact * pixels + i];
        const float transmittance = std::clamp(exact + y[2 * pixels + i], 0.0f, 1.0f);
        const glm::vec3 c(color[i], color[pixels + i], color[2 * pixels + i]);
        const float luminance = glm::dot(c, kLuminance);
        const glm::vec3 hue = luminance > 0.0f ? c / luminance : glm::vec3(1.0f);
        picture.pixels[i] = glm::vec4(brightness * hue + transmittance * kHairValidationGrey, 1.0f);
    }
    return picture;
}

Filtered filter(Context& context, const UNetDesc& net, Parameters& parameters,
                const HairTrainingFrame& frame)
{
    HairBatch batch = makeHairBatch(1, frame.size);
    fillHairCrop(batch, 0, frame, 0, glm::uvec2(0), {});
    RenderGraph graph(context);
    ParameterIds ids(graph, parameters);
    const HairEvaluation result = addHairEvaluation(graph, net, ids, batch);
    graph.execute();
    return {result.loss.value(graph), composite(graph.read<float>(result.y.buffer),
                                                graph.read<float>(result.filtered.buffer), batch)};
}

// Radiance in three planes from `radiance` on, over the background by `transmittance`.
CpuImage pictureOf(const HairTrainingFrame& frame, std::size_t radiance, std::size_t transmittance,
                   std::size_t transmittancePlanes = 1)
{
    CpuImage picture(frame.size, frame.size);
    for (std::uint32_t y = 0; y < frame.size; ++y)
        for (std::uint32_t x = 0; x < frame.size; ++x) {
            float open = 0.0f;
            for (std::size_t i = 0; i < transmittancePlanes; ++i)
                open += frame.at(transmittance + i, x, y) / float(transmittancePlanes);
            const glm::vec3 hair(frame.at(radiance, x, y), frame.at(radiance + 1, x, y),
                                 frame.at(radiance + 2, x, y));
            picture.at(x, y) = glm::vec4(hair + open * kHairValidationGrey, 1.0f);
        }
    return picture;
}

CpuImage truthPicture(const HairTrainingFrame& frame)
{
    return pictureOf(frame, frame.targetPlane(), frame.targetPlane() + 3);
}

CpuImage averagePicture(const HairTrainingFrame& frame, std::uint32_t i)
{
    return pictureOf(frame, frame.averagePlane(i), frame.averagePlane(i) + 3);
}

CpuImage fourSamplesPicture(const HairTrainingFrame& frame)
{
    return pictureOf(frame, kHairMeanPlane, 8, 4); // the samples' transparencies are planes 8 to 11
}

double rootMeanSquare(const CpuImage& a, const CpuImage& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 difference(glm::vec3(a.pixels[i] - b.pixels[i]));
        sum += glm::dot(difference, difference) / 3.0;
    }
    return std::sqrt(sum / double(a.pixels.size()));
}

} // namespace

double HairValidation::relativeError() const
{
    double sum = 0.0;
    for (const HairFrameErrors& frame : frames)
        sum += frame.network / frame.average4;
    return frames.empty() ? 0.0 : sum / double(frames.size());
}

HairValidation validateHairNet(Context& context, const UNetDesc& net, Parameters& parameters,
                               std::span<const HairTrainingFrame> heldOut)
{
    HairValidation result;
    for (const HairTrainingFrame& frame : heldOut) {
        STRANDLIGHT_ASSERT(frame.hasAverages);
        const CpuImage truth = truthPicture(frame);
        const Filtered filtered = filter(context, net, parameters, frame);
        result.frames.push_back({rootMeanSquare(fourSamplesPicture(frame), truth),
                                 rootMeanSquare(averagePicture(frame, 0), truth),
                                 rootMeanSquare(averagePicture(frame, 1), truth),
                                 rootMeanSquare(filtered.picture, truth)});
        result.loss += filtered.loss / double(heldOut.size());
    }
    return result;
}

CpuImage hairValidationPicture(Context& context, const UNetDesc& net, Parameters& parameters,
                               const HairTrainingFrame& frame)
{
    const CpuImage parts[] = {fourSamplesPicture(frame), averagePicture(frame, 1),
                              filter(context, net, parameters, frame).picture, truthPicture(frame)};
    CpuImage row(frame.size * std::uint32_t(std::size(parts)), frame.size);
    for (std::uint32_t y = 0; y < row.height; ++y)
        for (std::uint32_t x = 0; x < row.width; ++x)
            row.at(x, y) = parts[x / frame.size].at(x % frame.size, y);
    return row;
}

} // namespace strandlight
