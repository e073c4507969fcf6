#include "engine/graph/pass_recorder.hpp"

#include <algorithm>

#include "engine/base/error.hpp"
#include "engine/graph/descriptor_writes.hpp"
#include "engine/graph/usage_info.hpp"
#include "engine/vk/image_formats.hpp"
#include "engine/vk/pipeline_store.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

PassRecorder::PassRecorder(RenderGraph::State& graph, VkCommandBuffer commands)
    : graph_(graph), vulkan_(graph.context->vulkan()), commands_(commands)
{
}

const std::string& PassRecorder::passName() const
{
    return graph_.description.passes[planned_->pass].name;
}

void PassRecorder::recordPass(const PlannedPass& planned)
{
    planned_ = &planned;
    vulkan_.beginLabel(commands_, passName());
    recordBarriers(planned);
    const PassCommands& pass = graph_.commands[planned.pass];
    if (pass.kind == PassKind::Raster)
        beginRendering(pass);
    bool first = true;
    for (const Command& command : pass.commands) {
        // Dispatches of one pass may feed each other; draws keep Vulkan's own raster order.
        if (!first && pass.kind != PassKind::Raster)
            fullBarrier(commands_);
        first = false;
        std::visit([&](const auto& c) { record(pass, c); }, command);
    }
    if (pass.kind == PassKind::Raster)
        vkCmdEndRendering(commands_);
    vulkan_.endLabel(commands_);
}

void PassRecorder::recordBarriers(const PlannedPass& planned)
{
    // Buffers need no barrier of their own: one memory barrier per pass carries the union of
    // what they ask for.
    VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    std::vector<VkImageMemoryBarrier2> images;
    for (const PlannedBarrier& barrier : planned.barriers) {
        const UsageInfo after = infoOf(barrier.after);
        UsageInfo before = infoOf(barrier.before);
        if (barrier.alias) { // whoever had this memory before must be done with it
            memory.srcStageMask |= VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            memory.srcAccessMask |= VK_ACCESS_2_MEMORY_WRITE_BIT;
            memory.dstStageMask |= VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            memory.dstAccessMask |= VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            before.stage = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            before.access = VK_ACCESS_2_MEMORY_WRITE_BIT;
        }
        ImageState* image = graph_.resources->image(barrier.resource);
        if (!image) {
            memory.srcStageMask |= before.stage;
            memory.srcAccessMask |= writesOnly(before.access);
            memory.dstStageMask |= after.stage;
            memory.dstAccessMask |= after.access;
            continue;
        }
        VkImageMemoryBarrier2 transition{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        transition.srcStageMask = before.stage;
        transition.srcAccessMask = barrier.alias ? before.access : writesOnly(before.access);
        transition.dstStageMask = after.stage;
        transition.dstAccessMask = after.access;
        const bool discard = barrier.alias;
        transition.oldLayout = discard ? VK_IMAGE_LAYOUT_UNDEFINED : image->layout;
        transition.newLayout = after.layout;
        transition.srcQueueFamilyIndex = transition.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        transition.image = image->handle;
        transition.subresourceRange = {aspectOf(image->desc.format), 0, 1, 0, image->desc.layers};
        image->layout = after.layout;
        images.push_back(transition);
    }
    if (memory.dstStageMask == 0 && images.empty())
        return;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = memory.dstStageMask ? 1 : 0;
    info.pMemoryBarriers = &memory;
    info.imageMemoryBarrierCount = std::uint32_t(images.size());
    info.pImageMemoryBarriers = images.data();
    vkCmdPipelineBarrier2(commands_, &info);
}

void PassRecorder::beginRendering(const PassCommands& pass)
{
    if (pass.colors.empty() && !pass.hasDepth)
        throw GraphError("raster pass '" + passName() + "' draws into nothing");
    std::vector<VkRenderingAttachmentInfo> colors;
    VkExtent2D extent{~0u, ~0u};
    const auto attach = [&](const Attachment& attachment, Usage usage) {
        const ImageState& image = *graph_.resources->image(attachment.resource);
        extent.width = std::min(extent.width, image.desc.width);
        extent.height = std::min(extent.height, image.desc.height);
        VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        info.imageView = image.view;
        info.imageLayout = infoOf(usage).layout;
        info.loadOp =
            attachment.load.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        info.storeOp =
            usage == Usage::DepthRead ? VK_ATTACHMENT_STORE_OP_NONE : VK_ATTACHMENT_STORE_OP_STORE;
        if (usage == Usage::ColorAttachment)
            for (int c = 0; c < 4; ++c)
                info.clearValue.color.float32[c] = attachment.load.clearValue[c];
        else
            info.clearValue.depthStencil = {attachment.load.clearValue.x, 0};
        return info;
    };
    for (const Attachment& color : pass.colors)
        colors.push_back(attach(color, Usage::ColorAttachment));
    VkRenderingAttachmentInfo depth{};
    if (pass.hasDepth)
        depth = attach(pass.depth, pass.depthReadOnly ? Usage::DepthRead : Usage::DepthAttachment);
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea.extent = extent;
    info.layerCount = 1;
    info.colorAttachmentCount = std::uint32_t(colors.size());
    info.pColorAttachments = colors.data();
    info.pDepthAttachment = pass.hasDepth ? &depth : nullptr;
    vkCmdBeginRendering(commands_, &info);
    const VkViewport viewport{0.0f, 0.0f, float(extent.width), float(extent.height), 0.0f, 1.0f};
    vkCmdSetViewport(commands_, 0, 1, &viewport);
    vkCmdSetScissor(commands_, 0, 1, &info.renderArea);
}

void PassRecorder::record(const PassCommands&, const DispatchCommand& command)
{
    const Pipeline& pipeline = vulkan_.pipelines->compute(*command.kernel, command.constants);
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
    bind(pipeline, VK_PIPELINE_BIND_POINT_COMPUTE, command.kernel->name, command.bindings,
         command.push);
    if (command.indirect.valid()) {
        vkCmdDispatchIndirect(commands_, graph_.resources->buffer(command.indirect.index)->handle,
                              command.indirectOffset);
        return;
    }
    const auto size = pipeline.reflection.localSizeWith(command.constants);
    std::uint32_t groups[3];
    for (int axis = 0; axis < 3; ++axis) {
        groups[axis] = (command.threads[axis] + size[axis] - 1) / size[axis];
        if (groups[axis] > vulkan_.properties.limits.maxComputeWorkGroupCount[axis])
            throw GraphError("pass '" + passName() + "', kernel " + command.kernel->name + ": " +
                             std::to_string(groups[axis]) + " groups exceed the device's limit");
    }
    if (groups[0] && groups[1] && groups[2])
        vkCmdDispatch(commands_, groups[0], groups[1], groups[2]);
}

void PassRecorder::record(const PassCommands& pass, const DrawCommand& command)
{
    RasterTargets targets;
    for (const Attachment& color : pass.colors)
        targets.colors.push_back(graph_.description.resources[color.resource].image.format);
    targets.depth = pass.hasDepth;
    targets.samples =
        graph_.description
            .resources[pass.colors.empty() ? pass.depth.resource : pass.colors[0].resource]
            .image.samples;
    const Pipeline& pipeline = vulkan_.pipelines->raster(command.pipeline, targets);
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
    bind(pipeline, VK_PIPELINE_BIND_POINT_GRAPHICS, command.pipeline.fragment->name,
         command.bindings, command.push);
    vkCmdDraw(commands_, command.vertexCount, command.instanceCount, 0, 0);
}

void PassRecorder::record(const PassCommands&, const FillCommand& command)
{
    vkCmdFillBuffer(commands_, graph_.resources->buffer(command.buffer.index)->handle, 0,
                    VK_WHOLE_SIZE, command.word);
}

void PassRecorder::record(const PassCommands&, const CopyCommand& command)
{
    const VkBufferCopy region{0, 0, command.bytes};
    vkCmdCopyBuffer(commands_, graph_.resources->buffer(command.from.index)->handle,
                    graph_.resources->buffer(command.to.index)->handle, 1, &region);
}

void PassRecorder::bind(const Pipeline& pipeline, VkPipelineBindPoint point, const char* kernel,
                        const std::vector<Binding>& bindings, const std::vector<std::byte>& push)
{
    const std::uint32_t wanted = pipeline.reflection.pushBytes;
    if (wanted > push.size() || (wanted == 0 && push.size() > 1))
        throw GraphError("pass '" + passName() + "', kernel " + kernel + " declares " +
                         std::to_string(wanted) + " bytes of push constants, " +
                         std::to_string(push.size()) + " were given");
    if (wanted)
        vkCmdPushConstants(commands_, pipeline.layout, pipeline.stages, 0, wanted, push.data());
    DescriptorWrites(graph_, planned_->pass, kernel, pipeline.reflection, bindings)
        .push(commands_, point, pipeline.layout);
}

} // namespace strandlight
