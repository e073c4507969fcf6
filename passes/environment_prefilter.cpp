#include "passes/environment_prefilter.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "engine/base/log.hpp"
#include "kernels/env.gen.hpp"
#include "shaders/shared/sampling.h"

namespace strandlight {
namespace {

// Half the size; rows nearer the equator weigh more, as their solid angle does.
CpuImage halve(const CpuImage& from)
{
    CpuImage to(std::max(from.width / 2, 1u), std::max(from.height / 2, 1u));
    for (std::uint32_t y = 0; y < to.height; ++y)
        for (std::uint32_t x = 0; x < to.width; ++x) {
            glm::vec4 sum(0.0f);
            float total = 0.0f;
            for (std::uint32_t j = 0; j < 2; ++j)
                for (std::uint32_t i = 0; i < 2; ++i) {
                    const std::uint32_t row = std::min(2 * y + j, from.height - 1);
                    const float weight =
                        std::sin(gpu::kPi * (float(row) + 0.5f) / float(from.height));
                    sum += weight * from.at(std::min(2 * x + i, from.width - 1), row);
                    total += weight;
                }
            to.at(x, y) = sum / total;
        }
    return to;
}

} // namespace

EnvironmentPyramid buildEnvironmentPyramid(const Environment& environment,
                                           std::uint64_t maximumBytes)
{
    CpuImage level = environment.latLong;
    // A full pyramid is 4/3 of its finest level.
    while (level.pixels.size() * sizeof(glm::vec4) * 4 / 3 > maximumBytes) {
        logInfo("environment of " + std::to_string(level.width) + "x" +
                std::to_string(level.height) + " halved to fit one buffer");
        level = halve(level);
    }
    EnvironmentPyramid pyramid;
    pyramid.shape = {level.width, level.height, 1};
    pyramid.texels = level.pixels;
    while (level.width > 4 && level.height > 2) {
        level = halve(level);
        pyramid.texels.insert(pyramid.texels.end(), level.pixels.begin(), level.pixels.end());
        ++pyramid.shape.levels;
    }
    return pyramid;
}

EnvironmentIds addEnvironment(RenderGraph& graph, const Environment& environment)
{
    const EnvironmentPyramid pyramid = buildEnvironmentPyramid(environment);
    EnvironmentIds ids;
    ids.shape = pyramid.shape;
    ids.pyramid =
        graph.uploadBuffer("environment pyramid", std::span<const glm::vec4>(pyramid.texels));
    return ids;
}

EnvironmentIds addEnvironmentPrefilterPass(RenderGraph& graph, EnvironmentIds environment)
{
    constexpr std::uint32_t kTexels =
        gpu::kPrefilterLevels * gpu::kPrefilterWidth * gpu::kPrefilterHeight;
    PassBuilder pass = graph.addComputePass("environment prefilter");
    pass.read(environment.pyramid);
    environment.prefiltered = pass.write(
        graph.createBuffer("environment prefiltered", std::uint64_t(kTexels) * sizeof(glm::vec4)));
    pass.dispatch(kernels::environment_prefilter, {kTexels, 1, 1},
                  gpu::PrefilterPush{environment.shape},
                  {environment.pyramid, environment.prefiltered});
    return environment;
}

ImageId addSkyPass(RenderGraph& graph, ImageId position, const EnvironmentIds& environment,
                   const gpu::CameraRays& camera, ImageId lit)
{
    PassBuilder pass = graph.addComputePass("sky");
    pass.read(position);
    pass.read(environment.pyramid);
    const ImageId out = pass.write(lit);
    const glm::uvec3 extent = graph.extent(out);
    const gpu::SkyPush push{camera, extent.x, extent.y, environment.shape};
    pass.dispatch(kernels::sky, extent, push, {position, environment.pyramid, out});
    return out;
}

} // namespace strandlight
