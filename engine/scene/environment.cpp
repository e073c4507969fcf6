#include "engine/scene/environment.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/log.hpp"

namespace strandlight {

namespace {

void checkRadiance(CpuImage& image, const std::filesystem::path& path)
{
    std::size_t negative = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        glm::vec4& pixel = image.pixels[i];
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(pixel[c]))
                throw FileError(path.string(),
                                "texel " + std::to_string(i % image.width) + "," +
                                    std::to_string(i / image.width),
                                "is not finite");
            if (pixel[c] < 0.0f) {
                pixel[c] = 0.0f;
                ++negative;
            }
            sum += pixel[c];
        }
        pixel.w = 1.0f;
    }
    if (negative > 0)
        logWarning(path.string() + ": " + std::to_string(negative) + " negative values set to 0");
    if (!(sum > 0.0))
        throw FileError(path.string(), "", "the environment is black everywhere");
}

} // namespace

Environment loadEnvironment(const std::filesystem::path& path)
{
    const std::string suffix = path.extension().string();
    if (suffix != ".hdr" && suffix != ".HDR" && suffix != ".exr" && suffix != ".EXR")
        throw FileError(path.string(), "", "an environment must be a .hdr or .exr file");
    Environment environment{loadImage(path)};
    checkRadiance(environment.latLong, path);
    return environment;
}

glm::vec3 environmentRadiance(const Environment& environment, glm::vec3 direction)
{
    const CpuImage& image = environment.latLong;
    const glm::vec2 uv = gpu::environmentUv(direction);
    const float x = uv.x * float(image.width) - 0.5f;
    const float y = uv.y * float(image.height) - 0.5f;
    const int x0 = static_cast<int>(std::floor(x));
    const int y0 = static_cast<int>(std::floor(y));
    const int width = static_cast<int>(image.width);
    const auto texel = [&](int tx, int ty) {
        const int row = std::clamp(ty, 0, static_cast<int>(image.height) - 1);
        const int column = ((tx % width) + width) % width;
        return glm::vec3(image.at(std::uint32_t(column), std::uint32_t(row)));
    };
    const float fx = x - float(x0);
    const float fy = y - float(y0);
    const glm::vec3 top = glm::mix(texel(x0, y0), texel(x0 + 1, y0), fx);
    const glm::vec3 bottom = glm::mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), fx);
    return glm::mix(top, bottom, fy);
}

} // namespace strandlight
