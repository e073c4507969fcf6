// What the user has said so far: resources, passes, uses, roots. Plain data; the input of the
// planner.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/graph/desc.hpp"

namespace strandlight {

enum class ResourceKind : std::uint32_t
{
    Buffer,
    Image
};

struct ResourceDescription
{
    std::string name;
    ResourceKind kind = ResourceKind::Buffer;
    BufferDesc buffer;
    ImageDesc image;
    bool imported = false;    // memory is someone else's; writes are roots
    bool hasContents = false; // readable before any pass writes it
    bool output = false;
    std::uint32_t version = 0; // the live one
    std::uint64_t bytes() const
    {
        return kind == ResourceKind::Buffer ? buffer.bytes : image.bytes();
    }
};

// One use of one resource by one pass. A write makes version + 1.
struct UseDescription
{
    std::uint32_t resource = 0;
    Usage usage = Usage::None;
    std::uint32_t version = 0; // read, or written over
};

struct PassDescription
{
    std::string name;
    bool keep = false;
    std::vector<UseDescription> uses; // at most one per resource
};

struct GraphDescription
{
    std::vector<ResourceDescription> resources;
    std::vector<PassDescription> passes;
};

} // namespace strandlight
