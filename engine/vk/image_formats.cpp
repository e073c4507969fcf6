#include "engine/vk/image_formats.hpp"

#include <cstring>

#include <glm/gtc/packing.hpp>

namespace strandlight {

std::uint32_t bytesPerPixel(Format format)
{
    static const std::uint32_t kBytes[] = {4, 4, 8, 4, 8, 16, 2, 4};
    return kBytes[std::size_t(format)];
}

const char* toString(Format format)
{
    static const char* const kNames[] = {"R32F",    "R32UI",   "RG32F", "RGBA8",
                                         "RGBA16F", "RGBA32F", "R16F",  "Depth32F"};
    return kNames[std::size_t(format)];
}

VkFormat toVulkan(Format format)
{
    static const VkFormat kFormats[] = {
        VK_FORMAT_R32_SFLOAT,          VK_FORMAT_R32_UINT,
        VK_FORMAT_R32G32_SFLOAT,       VK_FORMAT_R8G8B8A8_UNORM,
        VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT,
        VK_FORMAT_R16_SFLOAT,          VK_FORMAT_D32_SFLOAT};
    return kFormats[std::size_t(format)];
}

VkImageAspectFlags aspectOf(Format format)
{
    return format == Format::Depth32F ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

void encodePixel(Format format, const glm::vec4& value, std::byte* out)
{
    const auto store = [&](const auto& v) { std::memcpy(out, &v, bytesPerPixel(format)); };
    switch (format) {
    case Format::R32F:
    case Format::Depth32F:
        store(value.x);
        break;
    case Format::R32UI:
        store(std::uint32_t(value.x));
        break;
    case Format::RG32F:
        store(glm::vec2(value));
        break;
    case Format::RGBA8:
        store(glm::packUnorm4x8(value));
        break;
    case Format::RGBA16F:
        store(glm::packHalf4x16(value));
        break;
    case Format::RGBA32F:
        store(value);
        break;
    case Format::R16F:
        store(glm::packHalf1x16(value.x));
        break;
    }
}

glm::vec4 decodePixel(Format format, const std::byte* in)
{
    const auto load = [&](auto v) {
        std::memcpy(&v, in, bytesPerPixel(format));
        return v;
    };
    switch (format) {
    case Format::R32F:
    case Format::Depth32F:
        return glm::vec4(load(0.0f), 0.0f, 0.0f, 1.0f);
    case Format::R32UI:
        return glm::vec4(float(load(std::uint32_t(0))), 0.0f, 0.0f, 1.0f);
    case Format::RG32F:
        return glm::vec4(load(glm::vec2(0.0f)), 0.0f, 1.0f);
    case Format::RGBA8:
        return glm::unpackUnorm4x8(load(std::uint32_t(0)));
    case Format::RGBA16F:
        return glm::unpackHalf4x16(load(std::uint64_t(0)));
    case Format::RGBA32F:
        return load(glm::vec4(0.0f));
    case Format::R16F:
        return glm::vec4(glm::unpackHalf1x16(load(std::uint16_t(0))), 0.0f, 0.0f, 1.0f);
    }
    return glm::vec4(0.0f);
}

} // namespace strandlight
