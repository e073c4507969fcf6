// The render graph as its users see it: create, read, write, output, run.
// A graph is built fresh from values. compile() is pure CPU work; execute() records, submits and
// waits.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/base/image.hpp"
#include "engine/graph/desc.hpp"
#include "engine/graph/handles.hpp"
#include "engine/graph/pass_builder.hpp"
#include "engine/vk/buffer.hpp"
#include "engine/vk/context.hpp"
#include "engine/vk/image.hpp"

namespace strandlight {

enum class Timings
{
    None,
    Whole, // one row, from the first pass to the last, as it runs without being timed
    Passes // a row a pass that ran; each is then fenced by full barriers
};

struct PassTiming
{
    std::string pass;
    double milliseconds = 0.0;
};

struct GraphPlan;

class RenderGraph
{
public:
    struct PlanOnly
    {
    };
    explicit RenderGraph(Context& context);
    // No device: compile(), text() and graphviz() work, execute() throws.
    explicit RenderGraph(PlanOnly);
    ~RenderGraph();
    RenderGraph(const RenderGraph&) = delete;
    RenderGraph& operator=(const RenderGraph&) = delete;

    const Context& context() const; // the device, for limits that passes depend on

    // --- resources ---
    // Transient: memory exists between first and last use and may be shared with others.
    BufferId createBuffer(std::string_view name, std::uint64_t bytes);
    ImageId createImage(std::string_view name, const ImageDesc& desc);
    // A transient buffer filled with `data` before its first use.
    template <class T> BufferId uploadBuffer(std::string_view name, std::span<const T> data)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        return uploadBytes(name, std::as_bytes(data));
    }
    // Borrowed: must outlive execute(). Importing the same object twice gives the same handle.
    // A pass that writes an import is never culled.
    BufferId importBuffer(Buffer& buffer);
    ImageId importImage(Image& image);

    const BufferDesc& desc(BufferId buffer) const;
    const ImageDesc& desc(ImageId image) const;
    glm::uvec3 extent(ImageId image) const; // (width, height, layers)

    // --- passes ---
    PassBuilder addComputePass(std::string_view name);
    PassBuilder addRasterPass(std::string_view name);
    PassBuilder addTransferPass(std::string_view name);

    // --- roots and running ---
    void output(BufferId buffer); // what does not reach an output or an import is culled
    void output(ImageId image);
    const GraphPlan& compile(); // throws GraphError naming pass and resource
    void execute();             // compiles if that has not happened
    void run() { execute(); }

    // After execute(), for outputs and imports.
    CpuImage read(ImageId image, std::uint32_t layer = 0) const;
    template <class T> std::vector<T> read(BufferId buffer) const
    {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::vector<std::byte> bytes = readBytes(buffer);
        std::vector<T> values(bytes.size() / sizeof(T));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
        return values;
    }
    std::vector<std::byte> readBytes(BufferId buffer) const;

    // Of the last execute(), in the order of passes; to be set before it.
    void setTimings(Timings timings);
    const std::vector<PassTiming>& timings() const;

    std::string text() const; // the compiled plan, one line a pass
    std::string graphviz() const;

    struct State; // engine/graph/graph_state.hpp

private:
    friend class PassBuilder;
    BufferId uploadBytes(std::string_view name, std::span<const std::byte> data);

    std::unique_ptr<State> state_;
};

} // namespace strandlight
