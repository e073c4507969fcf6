// What a shader declares, read from its SPIR-V: bindings of set 0, push constant size, local size.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/kernel_blob.hpp"

namespace strandlight {

enum class BindingKind : std::uint32_t
{
    StorageBuffer,
    StorageTexelBuffer,
    StorageImage,
    SampledImage
};

const char* toString(BindingKind kind);

struct ReflectedBinding
{
    std::uint32_t binding = 0;
    BindingKind kind = BindingKind::StorageBuffer;
    std::uint32_t imageFormat = 0; // SpvImageFormat of texel buffers and storage images
    bool readOnly = false;         // declared `readonly` in the shader
};

struct Reflection
{
    std::vector<ReflectedBinding> bindings; // sorted, 0, 1, 2, ... without gaps
    std::uint32_t pushBytes = 0;
    std::array<std::uint32_t, 3> localSize{1, 1, 1};
    std::array<std::uint32_t, 3> localSizeIds{~0u, ~0u,
                                              ~0u}; // specialisation constant ids, ~0: fixed

    // Local size under the given specialisation constants 0, 1, 2, ...
    std::array<std::uint32_t, 3> localSizeWith(std::span<const std::uint32_t> constants) const;
};

// Throws Error naming the shader when it uses what the engine does not offer (other sets, other
// descriptor types).
Reflection reflect(const KernelBlob& blob);

} // namespace strandlight
