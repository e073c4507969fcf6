#include "engine/graph/render_graph.hpp"

#include <utility>

#include "engine/base/error.hpp"
#include "engine/graph/executor.hpp"
#include "engine/graph/graph_state.hpp"

namespace strandlight {

RenderGraph::RenderGraph(Context& context) : state_(std::make_unique<State>())
{
    state_->context = &context;
}
RenderGraph::RenderGraph(PlanOnly) : state_(std::make_unique<State>()) {}
RenderGraph::~RenderGraph() = default;

std::uint32_t RenderGraph::State::addResource(ResourceDescription resource)
{
    if (plan)
        throw GraphError("'" + resource.name + "' was added after compile(): build a new graph");
    description.resources.push_back(std::move(resource));
    importedBuffers.push_back(nullptr);
    importedImages.push_back(nullptr);
    return std::uint32_t(description.resources.size() - 1);
}

std::uint32_t RenderGraph::State::use(std::uint32_t pass, std::uint32_t resource,
                                      std::uint32_t version, Usage usage)
{
    PassDescription& user = description.passes[pass];
    if (plan)
        throw GraphError("pass '" + user.name + "' was changed after compile(): build a new graph");
    if (resource >= description.resources.size())
        throw GraphError("pass '" + user.name +
                         "' uses a handle that no create or import returned");
    ResourceDescription& used = description.resources[resource];
    for (UseDescription& earlier : user.uses) {
        if (earlier.resource != resource)
            continue;
        const std::uint32_t now = earlier.version + (writes(earlier.usage) ? 1 : 0);
        if (earlier.usage == usage && (version == earlier.version || version == now))
            return now;
        throw GraphError("pass '" + user.name + "' uses '" + used.name + "' as " +
                         toString(earlier.usage) + " and as " + toString(usage) +
                         ": a pass uses a resource in one way");
    }
    if (version != used.version) {
        std::string writer = "a later pass";
        for (const PassDescription& other : description.passes)
            for (const UseDescription& use : other.uses)
                if (use.resource == resource && writes(use.usage) && use.version == version)
                    writer = "pass '" + other.name + "'";
        throw GraphError("pass '" + user.name + "' uses version " + std::to_string(version) +
                         " of '" + used.name + "', but " + writer + " has written version " +
                         std::to_string(version + 1));
    }
    user.uses.push_back({resource, usage, version});
    return writes(usage) ? ++used.version : version;
}

const Context& RenderGraph::context() const
{
    return *state_->context;
}

BufferId RenderGraph::createBuffer(std::string_view name, std::uint64_t bytes)
{
    if (bytes == 0)
        throw GraphError("buffer '" + std::string(name) + "' has no bytes");
    ResourceDescription resource;
    resource.name = name;
    resource.buffer.bytes = bytes;
    return {state_->addResource(std::move(resource)), 0};
}

ImageId RenderGraph::createImage(std::string_view name, const ImageDesc& desc)
{
    if (desc.width == 0 || desc.height == 0 || desc.layers == 0)
        throw GraphError("image '" + std::string(name) + "' has no pixels");
    ResourceDescription resource;
    resource.name = name;
    resource.kind = ResourceKind::Image;
    resource.image = desc;
    return {state_->addResource(std::move(resource)), 0};
}

BufferId RenderGraph::uploadBytes(std::string_view name, std::span<const std::byte> data)
{
    // A binding cannot be empty: an empty array becomes one zeroed word.
    const std::uint64_t bytes = data.empty() ? 16 : data.size();
    const BufferId id = createBuffer(name, bytes);
    state_->description.resources[id.index].hasContents = true;
    if (state_->context) {
        Buffer& buffer = state_->uploads.emplace_back(*state_->context, bytes, std::string(name));
        buffer.upload(data);
        state_->importedBuffers[id.index] = &buffer;
    }
    return id;
}

BufferId RenderGraph::importBuffer(Buffer& buffer)
{
    for (std::uint32_t i = 0; i < state_->importedBuffers.size(); ++i)
        if (state_->importedBuffers[i] == &buffer)
            return {i, state_->description.resources[i].version};
    ResourceDescription resource;
    resource.name = buffer.name();
    resource.buffer.bytes = buffer.bytes();
    resource.imported = resource.hasContents = true;
    const BufferId id{state_->addResource(std::move(resource)), 0};
    state_->importedBuffers[id.index] = &buffer;
    return id;
}

ImageId RenderGraph::importImage(Image& image)
{
    for (std::uint32_t i = 0; i < state_->importedImages.size(); ++i)
        if (state_->importedImages[i] == &image)
            return {i, state_->description.resources[i].version};
    ResourceDescription resource;
    resource.name = image.name();
    resource.kind = ResourceKind::Image;
    resource.image = image.desc();
    resource.imported = resource.hasContents = true;
    const ImageId id{state_->addResource(std::move(resource)), 0};
    state_->importedImages[id.index] = &image;
    return id;
}

const BufferDesc& RenderGraph::desc(BufferId buffer) const
{
    return state_->description.resources.at(buffer.index).buffer;
}

const ImageDesc& RenderGraph::desc(ImageId image) const
{
    return state_->description.resources.at(image.index).image;
}

glm::uvec3 RenderGraph::extent(ImageId image) const
{
    const ImageDesc& d = desc(image);
    return {d.width, d.height, d.layers};
}

namespace {

PassDescription namedPass(std::string_view name)
{
    PassDescription pass;
    pass.name = name;
    return pass;
}

} // namespace

PassBuilder RenderGraph::addComputePass(std::string_view name)
{
    if (state_->plan)
        throw GraphError("pass '" + std::string(name) +
                         "' was added after compile(): build a new graph");
    state_->description.passes.push_back(namedPass(name));
    state_->commands.emplace_back();
    return PassBuilder(*this, std::uint32_t(state_->description.passes.size() - 1));
}

PassBuilder RenderGraph::addRasterPass(std::string_view name)
{
    PassBuilder pass = addComputePass(name);
    state_->commands.back().kind = PassKind::Raster;
    return pass;
}

PassBuilder RenderGraph::addTransferPass(std::string_view name)
{
    PassBuilder pass = addComputePass(name);
    state_->commands.back().kind = PassKind::Transfer;
    return pass;
}

void RenderGraph::output(BufferId buffer)
{
    if (state_->plan)
        throw GraphError("output() after compile(): build a new graph");
    if (!buffer.valid() || buffer.version != state_->description.resources.at(buffer.index).version)
        throw GraphError("output() of an old version: use the handle that the last write returned");
    state_->description.resources[buffer.index].output = true;
}

void RenderGraph::output(ImageId image)
{
    output(BufferId{image.index, image.version});
}

const GraphPlan& RenderGraph::compile()
{
    if (!state_->plan)
        state_->plan = planGraph(state_->description);
    return *state_->plan;
}

void RenderGraph::execute()
{
    compile();
    if (!state_->context)
        throw GraphError("this graph only plans: it was made without a device");
    if (!state_->resources)
        state_->resources = std::make_unique<GraphResources>(*state_);
    executeGraph(*state_);
}

CpuImage RenderGraph::read(ImageId image, std::uint32_t layer) const
{
    if (!state_->resources)
        throw GraphError("read() before execute()");
    return state_->resources->readImage(image.index, layer);
}

std::vector<std::byte> RenderGraph::readBytes(BufferId buffer) const
{
    if (!state_->resources)
        throw GraphError("read() before execute()");
    return state_->resources->readBuffer(buffer.index);
}

void RenderGraph::setTimings(Timings timings)
{
    state_->timed = timings;
}
const std::vector<PassTiming>& RenderGraph::timings() const
{
    return state_->timings;
}

std::string RenderGraph::text() const
{
    return toText(state_->plan ? *state_->plan : planGraph(state_->description));
}

std::string RenderGraph::graphviz() const
{
    return toGraphviz(state_->plan ? *state_->plan : planGraph(state_->description));
}

} // namespace strandlight
