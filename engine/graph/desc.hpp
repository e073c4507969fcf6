// What a resource is and what a pass does to it. Values only; no Vulkan objects.
#pragma once

#include <cstdint>

#include "engine/vk/image_desc.hpp"

namespace strandlight {

struct BufferDesc
{
    std::uint64_t bytes = 0;
    friend bool operator==(const BufferDesc&, const BufferDesc&) = default;
};

// How a pass uses a resource. One entry of the barrier table each.
enum class Usage : std::uint32_t
{
    None,
    ShaderRead,  // storage buffer, texel buffer, storage image
    ShaderWrite, // the same, read and written
    Sample,      // combined image sampler
    ColorAttachment,
    DepthAttachment,
    DepthRead, // depth test without writing
    IndirectArguments,
    TransferRead,
    TransferWrite
};

bool writes(Usage usage);
const char* toString(Usage usage);

} // namespace strandlight
