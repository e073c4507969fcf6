// A graphics pipeline as a plain description: two shaders and the few states that passes vary.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/kernel_blob.hpp"

namespace strandlight {

enum class Topology : std::uint32_t
{
    Triangles,
    Lines
};

enum class Blend : std::uint32_t
{
    None,
    Add,
    Multiply // destination * source
};

struct RasterDesc
{
    const KernelBlob* vertex = nullptr;
    const KernelBlob* fragment = nullptr;
    Topology topology = Topology::Triangles;
    bool depthTest = true;
    bool depthWrite = true;
    bool cullBack = false;
    Blend blend = Blend::None;
    bool alphaToCoverage = false; // the first colour's alpha decides how many samples are written
    std::vector<std::uint32_t> constants; // specialisation constants 0, 1, 2, ... of both stages
};

} // namespace strandlight
