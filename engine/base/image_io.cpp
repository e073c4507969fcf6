#include "engine/base/image_io.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/image_io_formats.hpp"
#include "engine/base/log.hpp"

// Only what we load: each further decoder of stb is attack surface. Radiance files are read by
// image_io_hdr.cpp because stb returns zeros for the missing part of a cut file.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_MAX_DIMENSIONS 16384
#define STBI_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace strandlight {

namespace {

constexpr glm::vec3 kNonFiniteColour(1.0f, 0.0f, 1.0f);

std::string lowerSuffix(const std::filesystem::path& path)
{
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

CpuImage linearFromImage8(const Image8& coded)
{
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = decodeSrgb(static_cast<float>(i) / 255.0f);
    CpuImage image(coded.width, coded.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::uint8_t* p = &coded.rgba[i * 4];
        image.pixels[i] = {table[p[0]], table[p[1]], table[p[2]],
                           static_cast<float>(p[3]) / 255.0f};
    }
    return image;
}

bool isFinite(glm::vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void appendToVector(void* context, void* data, int size)
{
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
}

} // namespace

void checkImageSize(std::uint64_t width, std::uint64_t height, const std::string& name)
{
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (width == 0 || height == 0)
        throw FileError(name, "", "the picture is empty (" + size + ")");
    if (width > kMaximumImageSide || height > kMaximumImageSide ||
        width * height > kMaximumImagePixels)
        throw FileError(name, "",
                        "the picture has " + size + " pixels; the limits are " +
                            std::to_string(kMaximumImageSide) + " per side and " +
                            std::to_string(kMaximumImagePixels) + " in all");
}

bool inflateExactly(std::span<const std::uint8_t> in, std::span<std::uint8_t> out)
{
    if (in.size() > INT_MAX || out.size() > INT_MAX)
        return false;
    const int got = stbi_zlib_decode_buffer(
        reinterpret_cast<char*>(out.data()), static_cast<int>(out.size()),
        reinterpret_cast<const char*>(in.data()), static_cast<int>(in.size()));
    return got == static_cast<int>(out.size());
}

float decodeSrgb(float coded)
{
    return coded <= 0.04045f ? coded / 12.92f : std::pow((coded + 0.055f) / 1.055f, 2.4f);
}

float encodeSrgb(float linear)
{
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

Image8 decodeImage8(std::span<const std::uint8_t> bytes, const std::string& name)
{
    if (bytes.size() > INT_MAX)
        throw FileError(name, "", "is larger than 2 GiB");
    const int size = static_cast<int>(bytes.size());

    // The header first: its size decides whether anything is allocated.
    int width = 0;
    int height = 0;
    int channels = 0;
    if (size == 0 || !stbi_info_from_memory(bytes.data(), size, &width, &height, &channels)) {
        const char* reason = size == 0 ? "the file is empty" : stbi_failure_reason();
        throw FileError(name, "", std::string("is not a readable PNG or JPEG picture: ") + reason);
    }
    checkImageSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), name);

    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels)
        throw FileError(name, "", std::string("broken picture data: ") + stbi_failure_reason());
    Image8 image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    image.rgba.assign(pixels.get(), pixels.get() + std::size_t(image.width) * image.height * 4);
    return image;
}

CpuImage loadImage(const std::filesystem::path& path)
{
    const std::string suffix = lowerSuffix(path);
    const std::string name = path.string();
    if (suffix == ".png" || suffix == ".jpg" || suffix == ".jpeg")
        return linearFromImage8(decodeImage8(readFile(path), name));
    if (suffix == ".hdr")
        return decodeHdr(readFile(path), name);
    if (suffix == ".exr")
        return decodeExr(readFile(path), name);
    throw FileError(name, "",
                    "unknown picture suffix \"" + suffix + "\"; use .png, .jpg, .hdr or .exr");
}

std::vector<std::uint8_t> encodePng(const CpuImage& image)
{
    checkImageSize(image.width, image.height, "PNG output");
    std::size_t broken = 0;
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.pixels.size() * 3);
    for (const glm::vec4& pixel : image.pixels) {
        glm::vec3 colour(pixel);
        if (!isFinite(colour)) {
            colour = kNonFiniteColour;
            ++broken;
        }
        for (int c = 0; c < 3; ++c) {
            const float coded = encodeSrgb(std::clamp(colour[c], 0.0f, 1.0f));
            rgb.push_back(static_cast<std::uint8_t>(coded * 255.0f + 0.5f));
        }
    }
    if (broken != 0)
        logWarning(std::to_string(broken) + " pixels are not finite and are shown in magenta");

    std::vector<std::uint8_t> bytes;
    const int width = static_cast<int>(image.width);
    if (!stbi_write_png_to_func(appendToVector, &bytes, width, static_cast<int>(image.height), 3,
                                rgb.data(), width * 3))
        throw Error("cannot encode a PNG of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height));
    return bytes;
}

void savePng(const std::filesystem::path& path, const CpuImage& image)
{
    writeFileAtomically(path, encodePng(image));
}

void saveExr(const std::filesystem::path& path, const CpuImage& image)
{
    writeFileAtomically(path, encodeExr(image, path.string()));
}

void saveImage(const std::filesystem::path& path, const CpuImage& image)
{
    const std::string suffix = lowerSuffix(path);
    if (suffix == ".png")
        savePng(path, image);
    else if (suffix == ".exr")
        saveExr(path, image);
    else
        throw Error(path.string() + ": unknown picture suffix \"" + suffix +
                    "\"; use .png or .exr");
}

} // namespace strandlight
