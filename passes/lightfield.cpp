#include "passes/lightfield.hpp"

#include <algorithm>
#include <string>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "engine/vk/context.hpp"
#include "shaders/shared/rgb9e5.h"

namespace strandlight {
namespace {

void appendWords(const Buffer& buffer, std::size_t count, std::vector<std::uint32_t>& words)
{
    const std::vector<std::uint32_t> part = buffer.downloadAs<std::uint32_t>();
    STRANDLIGHT_ASSERT(part.size() >= count);
    words.insert(words.end(), part.begin(), part.begin() + std::ptrdiff_t(count));
}

} // namespace

glm::vec3 CpuLightfield::radianceAt(std::uint32_t texel, std::uint32_t direction) const
{
    return gpu::unpackRgb9e5(radiance[std::size_t(texel) * size * size + direction]);
}

glm::vec3 CpuLightfield::environmentAt(std::uint32_t texel, std::uint32_t direction) const
{
    if (environment.empty())
        return glm::vec3(0.0f);
    return gpu::unpackRgb9e5(environment[std::size_t(texel) * size * size + direction]);
}

CpuLightfield downloadLightfield(const Lightfield& field)
{
    CpuLightfield cpu;
    cpu.size = field.size;
    cpu.texelCount = field.texelCount;
    cpu.valid = field.valid;
    for (const LightfieldPart& part : field.parts) {
        const std::size_t words = std::size_t(part.texelCount) * field.directionCount();
        appendWords(part.radiance, words, cpu.radiance);
        if (field.hasEnvironment)
            appendWords(part.environment, words, cpu.environment);
    }
    return cpu;
}

Lightfield uploadLightfield(Context& context, const CpuLightfield& cpu)
{
    const std::size_t perTexel = std::size_t(cpu.size) * cpu.size;
    if (cpu.radiance.size() != perTexel * cpu.texelCount || cpu.valid.size() != cpu.texelCount ||
        (!cpu.environment.empty() && cpu.environment.size() != cpu.radiance.size()))
        throw Error("light field of " + std::to_string(cpu.texelCount) + " texels with " +
                    std::to_string(perTexel) + " directions holds " +
                    std::to_string(cpu.radiance.size()) + " words");

    Lightfield field;
    field.size = cpu.size;
    field.texelCount = cpu.texelCount;
    field.hasEnvironment = !cpu.environment.empty();
    field.valid = cpu.valid;
    const std::uint64_t texelBytes = std::max<std::uint64_t>(perTexel * 4, 4);
    const auto texelsPerPart = std::uint32_t(context.maxStorageBufferBytes() / texelBytes);
    for (std::uint32_t first = 0; first < cpu.texelCount; first += texelsPerPart) {
        LightfieldPart part;
        part.firstTexel = first;
        part.texelCount = std::min(texelsPerPart, cpu.texelCount - first);
        const auto range = [&](const std::vector<std::uint32_t>& words) {
            return std::span(words).subspan(first * perTexel, part.texelCount * perTexel);
        };
        part.radiance = Buffer::from<std::uint32_t>(context, range(cpu.radiance), "light field");
        if (field.hasEnvironment)
            part.environment = Buffer::from<std::uint32_t>(context, range(cpu.environment),
                                                           "light field environment");
        field.parts.push_back(std::move(part));
    }
    return field;
}

std::vector<glm::vec3> unpackRadiance(const std::vector<std::uint32_t>& words)
{
    std::vector<glm::vec3> radiance(words.size());
    std::transform(words.begin(), words.end(), radiance.begin(), gpu::unpackRgb9e5);
    return radiance;
}

} // namespace strandlight
