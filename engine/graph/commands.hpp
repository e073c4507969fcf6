// What a pass runs, as values: recorded by PassBuilder, played by the executor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/pass_builder.hpp"

namespace strandlight {

struct DispatchCommand
{
    const KernelBlob* kernel = nullptr;
    glm::uvec3 threads = glm::uvec3(1);
    BufferId indirect; // valid: group counts come from here
    std::uint64_t indirectOffset = 0;
    std::vector<std::byte> push;
    std::vector<Binding> bindings;
    std::vector<std::uint32_t> constants;
};

struct DrawCommand
{
    RasterDesc pipeline;
    std::uint32_t vertexCount = 0;
    std::uint32_t instanceCount = 1;
    std::vector<std::byte> push;
    std::vector<Binding> bindings;
};

struct FillCommand
{
    BufferId buffer;
    std::uint32_t word = 0;
};

struct CopyCommand
{
    BufferId from;
    BufferId to;
    std::uint64_t bytes = 0;
};

using Command = std::variant<DispatchCommand, DrawCommand, FillCommand, CopyCommand>;

struct Attachment
{
    std::uint32_t resource = 0;
    LoadOp load;
};

enum class PassKind : std::uint32_t
{
    Compute,
    Raster,
    Transfer
};

// Beside PassDescription (which the planner sees): what the executor plays.
struct PassCommands
{
    PassKind kind = PassKind::Compute;
    std::vector<Command> commands;
    std::vector<Attachment> colors;
    Attachment depth;
    bool hasDepth = false;
    bool depthReadOnly = false;
};

} // namespace strandlight
