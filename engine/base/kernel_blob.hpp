// A shader as the build produced it: SPIR-V words and a name for messages.
#pragma once

#include <cstddef>
#include <cstdint>

namespace strandlight {

struct KernelBlob
{
    const char* name;
    const std::uint32_t* words;
    std::size_t wordCount;
};

} // namespace strandlight
