// One pass while it is being described: what it reads, what it writes, what it runs.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "engine/base/kernel_blob.hpp"
#include "engine/graph/desc.hpp"
#include "engine/graph/handles.hpp"
#include "engine/vk/raster_pipeline.hpp"

namespace strandlight {

class RenderGraph;
struct PassCommands;
enum class PassKind : std::uint32_t;

enum class Filter : std::uint32_t
{
    Linear,
    Nearest
};

// A descriptor of one dispatch or draw, in binding order of the shader (0, 1, 2, ...).
// Whether it is a storage buffer, a texel buffer, a storage image or a sampled image is read from
// the SPIR-V.
struct Binding
{
    std::variant<BufferId, ImageId> resource;
    Filter filter = Filter::Linear; // sampled images only
    std::uint64_t offset = 0;       // of buffers; bytes, a multiple of kAlignment
    std::uint64_t bytes = 0;        // of buffers; 0: to the end

    static constexpr std::uint64_t kAlignment = 256; // the most that a device may ask for

    Binding(BufferId id) : resource(id) {}
    Binding(BufferId id, std::uint64_t from, std::uint64_t size)
        : resource(id), offset(from), bytes(size)
    {
    }
    Binding(ImageId id, Filter f = Filter::Linear) : resource(id), filter(f) {}
};

struct LoadOp
{
    bool clear = true;
    glm::vec4 clearValue = glm::vec4(0.0f); // colour, or .x = depth
};

class PassBuilder
{
public:
    // --- declaring; each returns the handle to bind below ---
    BufferId read(BufferId buffer); // storage or texel buffer, read only
    ImageId read(ImageId image);    // storage image, read only
    ImageId sample(ImageId image);  // combined image sampler
    [[nodiscard]] BufferId
    write(BufferId buffer); // read and write; the returned version is the live one
    [[nodiscard]] ImageId write(ImageId image);
    [[nodiscard]] ImageId color(ImageId image, LoadOp load = {});
    [[nodiscard]] ImageId depth(ImageId image, LoadOp load = {true, glm::vec4(1.0f)});
    ImageId depthReadOnly(ImageId image);

    // --- running; several dispatches of one pass are ordered by full barriers ---
    // Threads, not groups: the group count comes from the shader's local size. `push` may be empty:
    // NoPush{}. `constants` are specialisation constants 0, 1, 2, ... (32-bit each).
    template <class Push>
    void dispatch(const KernelBlob& kernel, glm::uvec3 threads, const Push& push,
                  std::initializer_list<Binding> bindings,
                  std::vector<std::uint32_t> constants = {})
    {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= 128);
        addDispatch(kernel, threads, std::as_bytes(std::span(&push, 1)),
                    std::vector<Binding>(bindings), std::move(constants));
    }
    // Group counts from a buffer of three uints at byte `offset`.
    template <class Push>
    void dispatchIndirect(const KernelBlob& kernel, BufferId arguments, std::uint64_t offset,
                          const Push& push, std::initializer_list<Binding> bindings,
                          std::vector<std::uint32_t> constants = {})
    {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= 128);
        addDispatchIndirect(kernel, arguments, offset, std::as_bytes(std::span(&push, 1)),
                            std::vector<Binding>(bindings), std::move(constants));
    }
    // Vertices are pulled from storage buffers; there is no vertex input state.
    template <class Push>
    void draw(const RasterDesc& pipeline, std::uint32_t vertexCount, std::uint32_t instanceCount,
              const Push& push, std::initializer_list<Binding> bindings)
    {
        static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= 128);
        addDraw(pipeline, vertexCount, instanceCount, std::as_bytes(std::span(&push, 1)),
                std::vector<Binding>(bindings));
    }
    void fill(BufferId buffer, std::uint32_t word);             // after write(buffer)
    void copy(BufferId from, BufferId to, std::uint64_t bytes); // after read(from), write(to)

    void keep(); // never culled: the pass has an effect outside the graph

private:
    friend class RenderGraph;
    PassBuilder(RenderGraph& graph, std::uint32_t pass) : graph_(&graph), pass_(pass) {}

    BufferId use(BufferId id, Usage usage);
    ImageId use(ImageId id, Usage usage);
    BufferId readIndirect(BufferId buffer);
    void require(PassKind kind, const char* verb) const;
    void requireDeclared(BufferId buffer, Usage usage) const;
    PassCommands& commands() const;
    const std::string& name() const;
    void addDispatch(const KernelBlob& kernel, glm::uvec3 threads, std::span<const std::byte> push,
                     std::vector<Binding> bindings, std::vector<std::uint32_t> constants);
    void addDispatchIndirect(const KernelBlob& kernel, BufferId arguments, std::uint64_t offset,
                             std::span<const std::byte> push, std::vector<Binding> bindings,
                             std::vector<std::uint32_t> constants);
    void addDraw(const RasterDesc& pipeline, std::uint32_t vertexCount, std::uint32_t instanceCount,
                 std::span<const std::byte> push, std::vector<Binding> bindings);

    RenderGraph* graph_;
    std::uint32_t pass_;
};

struct NoPush
{
};

} // namespace strandlight
