#include "engine/graph/pass_builder.hpp"

#include "engine/base/error.hpp"
#include "engine/graph/graph_state.hpp"

namespace strandlight {

BufferId PassBuilder::use(BufferId id, Usage usage)
{
    return {id.index, graph_->state_->use(pass_, id.index, id.version, usage)};
}

ImageId PassBuilder::use(ImageId id, Usage usage)
{
    return {id.index, graph_->state_->use(pass_, id.index, id.version, usage)};
}

BufferId PassBuilder::read(BufferId buffer)
{
    const bool transfer = commands().kind == PassKind::Transfer;
    return use(buffer, transfer ? Usage::TransferRead : Usage::ShaderRead);
}

BufferId PassBuilder::write(BufferId buffer)
{
    const bool transfer = commands().kind == PassKind::Transfer;
    return use(buffer, transfer ? Usage::TransferWrite : Usage::ShaderWrite);
}

ImageId PassBuilder::read(ImageId image)
{
    return use(image, Usage::ShaderRead);
}
ImageId PassBuilder::sample(ImageId image)
{
    return use(image, Usage::Sample);
}
ImageId PassBuilder::write(ImageId image)
{
    return use(image, Usage::ShaderWrite);
}
BufferId PassBuilder::readIndirect(BufferId buffer)
{
    return use(buffer, Usage::IndirectArguments);
}

ImageId PassBuilder::color(ImageId image, LoadOp load)
{
    const ImageId id = use(image, Usage::ColorAttachment);
    commands().colors.push_back({id.index, load});
    return id;
}

ImageId PassBuilder::depth(ImageId image, LoadOp load)
{
    const ImageId id = use(image, Usage::DepthAttachment);
    commands().depth = {id.index, load};
    commands().hasDepth = true;
    return id;
}

ImageId PassBuilder::depthReadOnly(ImageId image)
{
    const ImageId id = use(image, Usage::DepthRead);
    commands().depth = {id.index, {false, glm::vec4(1.0f)}};
    commands().hasDepth = commands().depthReadOnly = true;
    return id;
}

void PassBuilder::keep()
{
    graph_->state_->description.passes[pass_].keep = true;
}

void PassBuilder::fill(BufferId buffer, std::uint32_t word)
{
    require(PassKind::Transfer, "fill");
    requireDeclared(buffer, Usage::TransferWrite);
    commands().commands.push_back(FillCommand{buffer, word});
}

void PassBuilder::copy(BufferId from, BufferId to, std::uint64_t bytes)
{
    require(PassKind::Transfer, "copy");
    requireDeclared(from, Usage::TransferRead);
    requireDeclared(to, Usage::TransferWrite);
    if (bytes > graph_->desc(from).bytes || bytes > graph_->desc(to).bytes)
        throw GraphError("pass '" + name() + "' copies " + std::to_string(bytes) +
                         " bytes, more than a buffer has");
    commands().commands.push_back(CopyCommand{from, to, bytes});
}

void PassBuilder::addDispatch(const KernelBlob& kernel, glm::uvec3 threads,
                              std::span<const std::byte> push, std::vector<Binding> bindings,
                              std::vector<std::uint32_t> constants)
{
    require(PassKind::Compute, "dispatch");
    DispatchCommand command;
    command.kernel = &kernel;
    command.threads = threads;
    command.push.assign(push.begin(), push.end());
    command.bindings = std::move(bindings);
    command.constants = std::move(constants);
    commands().commands.push_back(std::move(command));
}

void PassBuilder::addDispatchIndirect(const KernelBlob& kernel, BufferId arguments,
                                      std::uint64_t offset, std::span<const std::byte> push,
                                      std::vector<Binding> bindings,
                                      std::vector<std::uint32_t> constants)
{
    readIndirect(arguments);
    addDispatch(kernel, glm::uvec3(1), push, std::move(bindings), std::move(constants));
    DispatchCommand& command = std::get<DispatchCommand>(commands().commands.back());
    command.indirect = arguments;
    command.indirectOffset = offset;
}

void PassBuilder::addDraw(const RasterDesc& pipeline, std::uint32_t vertexCount,
                          std::uint32_t instanceCount, std::span<const std::byte> push,
                          std::vector<Binding> bindings)
{
    require(PassKind::Raster, "draw");
    DrawCommand command;
    command.pipeline = pipeline;
    command.vertexCount = vertexCount;
    command.instanceCount = instanceCount;
    command.push.assign(push.begin(), push.end());
    command.bindings = std::move(bindings);
    commands().commands.push_back(std::move(command));
}

void PassBuilder::require(PassKind kind, const char* verb) const
{
    static const char* const kNames[] = {"compute", "raster", "transfer"};
    if (graph_->state_->plan)
        throw GraphError("pass '" + name() + "' was changed after compile(): build a new graph");
    if (commands().kind != kind)
        throw GraphError("pass '" + name() + "' is a " + kNames[std::size_t(commands().kind)] +
                         " pass: " + verb + " belongs in a " + kNames[std::size_t(kind)] + " pass");
}

void PassBuilder::requireDeclared(BufferId buffer, Usage usage) const
{
    for (const UseDescription& use : graph_->state_->description.passes[pass_].uses)
        if (use.resource == buffer.index && use.usage == usage)
            return;
    throw GraphError("pass '" + name() +
                     "' has not declared a buffer that it works on: " + toString(usage));
}

PassCommands& PassBuilder::commands() const
{
    return graph_->state_->commands[pass_];
}
const std::string& PassBuilder::name() const
{
    return graph_->state_->description.passes[pass_].name;
}

} // namespace strandlight
