// Typed, versioned names for what a graph works on. A write returns the next version; the old one
// is dead.
#pragma once

#include <cstdint>

namespace strandlight {

struct BufferId
{
    std::uint32_t index = ~0u;
    std::uint32_t version = 0;
    bool valid() const { return index != ~0u; }
    friend bool operator==(const BufferId&, const BufferId&) = default;
};

struct ImageId
{
    std::uint32_t index = ~0u;
    std::uint32_t version = 0;
    bool valid() const { return index != ~0u; }
    friend bool operator==(const ImageId&, const ImageId&) = default;
};

} // namespace strandlight
