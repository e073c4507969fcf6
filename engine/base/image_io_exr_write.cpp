// Writes OpenEXR pictures through tinyexr.
#include "engine/base/image_io_formats.hpp"

#include <array>
#include <cstdlib>
#include <memory>

#include <tinyexr.h>

#include "engine/base/error.hpp"

namespace strandlight {

std::vector<std::uint8_t> encodeExr(const CpuImage& image, const std::string& name)
{
    checkImageSize(image.width, image.height, name);
    std::array<std::vector<float>, 3> planes; // in the file's order: B, G, R
    for (std::size_t c = 0; c < 3; ++c)
        for (const glm::vec4& pixel : image.pixels)
            planes[c].push_back(pixel[2 - static_cast<int>(c)]);
    std::array<unsigned char*, 3> pointers{};
    std::array<EXRChannelInfo, 3> infos{};
    std::array<int, 3> types{};
    for (std::size_t c = 0; c < 3; ++c) {
        pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
        infos[c].name[0] = "BGR"[c];
        types[c] = TINYEXR_PIXELTYPE_FLOAT;
    }
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = 3;
    header.channels = infos.data();
    header.pixel_types = types.data();
    header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage exr;
    InitEXRImage(&exr);
    exr.num_channels = 3;
    exr.width = static_cast<int>(image.width);
    exr.height = static_cast<int>(image.height);
    exr.images = pointers.data();

    unsigned char* memory = nullptr;
    const char* reason = nullptr;
    const std::size_t size = SaveEXRImageToMemory(&exr, &header, &memory, &reason);
    const std::unique_ptr<unsigned char, void (*)(void*)> owner(memory, std::free);
    if (size == 0) {
        const std::string text = reason != nullptr ? reason : "unknown reason";
        FreeEXRErrorMessage(reason);
        throw FileError(name, "", "cannot encode: " + text);
    }
    return {memory, memory + size};
}

} // namespace strandlight
