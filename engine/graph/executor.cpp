#include "engine/graph/executor.hpp"

#include <algorithm>
#include <string>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/image_formats.hpp"
#include "engine/vk/pipeline_store.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace {

// Vulkan's words for a use. Stages are as narrow as the kind of use allows; a graph pass may be
// compute or raster, so shader uses name both.
struct UsageInfo
{
    VkPipelineStageFlags2 stage;
    VkAccessFlags2 access;
    VkImageLayout layout;
};

UsageInfo infoOf(Usage usage)
{
    const VkPipelineStageFlags2 shaders = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                          VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                          VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    const VkPipelineStageFlags2 tests =
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
    switch (usage) {
    case Usage::ShaderRead:
        return {shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
    case Usage::ShaderWrite:
        return {shaders, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                VK_IMAGE_LAYOUT_GENERAL};
    case Usage::Sample:
        return {shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    case Usage::ColorAttachment:
        return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    case Usage::DepthAttachment:
        return {tests,
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    case Usage::DepthRead:
        return {tests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    case Usage::IndirectArguments:
        return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
                VK_IMAGE_LAYOUT_UNDEFINED};
    case Usage::TransferRead:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    case Usage::TransferWrite:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    case Usage::None:
        break;
    }
    return {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
}

VkAccessFlags2 writesOnly(VkAccessFlags2 access)
{
    return access &
           (VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

VkFormat texelFormat(std::uint32_t spirvFormat, const std::string& kernel)
{
    switch (spirvFormat) { // SPIR-V 1.6, 3.11 Image Format
    case 1:
        return VK_FORMAT_R32G32B32A32_SFLOAT;
    case 3:
        return VK_FORMAT_R32_SFLOAT;
    case 6:
        return VK_FORMAT_R32G32_SFLOAT;
    case 30:
        return VK_FORMAT_R32G32B32A32_UINT;
    case 33:
        return VK_FORMAT_R32_UINT;
    case 35:
        return VK_FORMAT_R32G32_UINT;
    default:
        throw Error(
            "shader " + kernel +
            ": a texel buffer needs the format r32f, rg32f, rgba32f, r32ui, rg32ui or rgba32ui");
    }
}

class Recorder
{
public:
    Recorder(RenderGraph::State& graph, VkCommandBuffer commands)
        : graph_(graph), vulkan_(graph.context->vulkan()), commands_(commands)
    {
    }

    void recordPass(const PlannedPass& planned)
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

private:
    const std::string& passName() const { return graph_.description.passes[planned_->pass].name; }

    void recordBarriers(const PlannedPass& planned)
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
            transition.srcQueueFamilyIndex = transition.dstQueueFamilyIndex =
                VK_QUEUE_FAMILY_IGNORED;
            transition.image = image->handle;
            transition.subresourceRange = {aspectOf(image->desc.format), 0, 1, 0,
                                           image->desc.layers};
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

    void beginRendering(const PassCommands& pass)
    {
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
            info.storeOp = usage == Usage::DepthRead ? VK_ATTACHMENT_STORE_OP_NONE
                                                     : VK_ATTACHMENT_STORE_OP_STORE;
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
            depth =
                attach(pass.depth, pass.depthReadOnly ? Usage::DepthRead : Usage::DepthAttachment);
        VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
        info.renderArea.extent = extent;
        info.layerCount = 1;
        info.colorAttachmentCount = std::uint32_t(colors.size());
        info.pColorAttachments = colors.data();
        info.pDepthAttachment = pass.hasDepth ? &depth : nullptr;
        vkCmdBeginRendering(commands_, &info);
        const VkViewport viewport{0.0f, 0.0f, float(extent.width), float(extent.height),
                                  0.0f, 1.0f};
        vkCmdSetViewport(commands_, 0, 1, &viewport);
        vkCmdSetScissor(commands_, 0, 1, &info.renderArea);
    }

    void record(const PassCommands&, const DispatchCommand& command)
    {
        const Pipeline& pipeline = vulkan_.pipelines->compute(*command.kernel, command.constants);
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
        bind(pipeline, VK_PIPELINE_BIND_POINT_COMPUTE, command.kernel->name, command.bindings,
             command.push);
        if (command.indirect.valid()) {
            vkCmdDispatchIndirect(commands_,
                                  graph_.resources->buffer(command.indirect.index)->handle,
                                  command.indirectOffset);
            return;
        }
        const auto size = pipeline.reflection.localSizeWith(command.constants);
        std::uint32_t groups[3];
        for (int axis = 0; axis < 3; ++axis) {
            groups[axis] = (command.threads[axis] + size[axis] - 1) / size[axis];
            if (groups[axis] > vulkan_.properties.limits.maxComputeWorkGroupCount[axis])
                throw GraphError("pass '" + passName() + "', kernel " + command.kernel->name +
                                 ": " + std::to_string(groups[axis]) +
                                 " groups exceed the device's limit");
        }
        if (groups[0] && groups[1] && groups[2])
            vkCmdDispatch(commands_, groups[0], groups[1], groups[2]);
    }

    void record(const PassCommands& pass, const DrawCommand& command)
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

    void record(const PassCommands&, const FillCommand& command)
    {
        vkCmdFillBuffer(commands_, graph_.resources->buffer(command.buffer.index)->handle, 0,
                        VK_WHOLE_SIZE, command.word);
    }

    void record(const PassCommands&, const CopyCommand& command)
    {
        const VkBufferCopy region{0, 0, command.bytes};
        vkCmdCopyBuffer(commands_, graph_.resources->buffer(command.from.index)->handle,
                        graph_.resources->buffer(command.to.index)->handle, 1, &region);
    }

    Usage declaredUsage(std::uint32_t resource, const std::string& kernel) const
    {
        for (const UseDescription& use : graph_.description.passes[planned_->pass].uses)
            if (use.resource == resource)
                return use.usage;
        throw GraphError("pass '" + passName() + "', kernel " + kernel + " binds '" +
                         graph_.description.resources[resource].name +
                         "', which the pass does not declare");
    }

    void bind(const Pipeline& pipeline, VkPipelineBindPoint point, const std::string& kernel,
              const std::vector<Binding>& bindings, const std::vector<std::byte>& push)
    {
        const std::uint32_t wanted = pipeline.reflection.pushBytes;
        if (wanted > push.size() || (wanted == 0 && push.size() > 1))
            throw GraphError("pass '" + passName() + "', kernel " + kernel + " declares " +
                             std::to_string(wanted) + " bytes of push constants, " +
                             std::to_string(push.size()) + " were given");
        if (wanted)
            vkCmdPushConstants(commands_, pipeline.layout, pipeline.stages, 0, wanted, push.data());

        std::vector<VkWriteDescriptorSet> writes;
        std::deque<VkDescriptorBufferInfo> bufferInfos;
        std::deque<VkDescriptorImageInfo> imageInfos;
        std::deque<VkBufferView> views;
        for (const ReflectedBinding& slot : pipeline.reflection.bindings) {
            if (slot.binding >= bindings.size())
                throw GraphError("pass '" + passName() + "', kernel " + kernel + ": binding " +
                                 std::to_string(slot.binding) + " (" + toString(slot.kind) +
                                 ") is not given");
            writes.push_back(
                describe(slot, bindings[slot.binding], kernel, bufferInfos, imageInfos, views));
        }
        if (!writes.empty())
            vkCmdPushDescriptorSetKHR(commands_, point, pipeline.layout, 0,
                                      std::uint32_t(writes.size()), writes.data());
    }

    VkWriteDescriptorSet describe(const ReflectedBinding& slot, const Binding& binding,
                                  const std::string& kernel,
                                  std::deque<VkDescriptorBufferInfo>& bufferInfos,
                                  std::deque<VkDescriptorImageInfo>& imageInfos,
                                  std::deque<VkBufferView>& views)
    {
        const bool isBuffer = std::holds_alternative<BufferId>(binding.resource);
        const std::uint32_t resource = isBuffer ? std::get<BufferId>(binding.resource).index
                                                : std::get<ImageId>(binding.resource).index;
        const bool wantsBuffer =
            slot.kind == BindingKind::StorageBuffer || slot.kind == BindingKind::StorageTexelBuffer;
        const Usage usage = declaredUsage(resource, kernel);
        const std::string& name = graph_.description.resources[resource].name;
        const std::string where = "pass '" + passName() + "', kernel " + kernel + ", binding " +
                                  std::to_string(slot.binding) + ": ";
        if (isBuffer != wantsBuffer ||
            (slot.kind == BindingKind::SampledImage) != (usage == Usage::Sample))
            throw GraphError(where + "the shader wants a " + toString(slot.kind) + ", '" + name +
                             "' is used as " + toString(usage));
        if (!slot.readOnly && usage == Usage::ShaderRead)
            throw GraphError(
                where + "the shader may write '" + name +
                "', the pass only reads it (say `readonly` in the shader, or write() in the pass)");

        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstBinding = slot.binding;
        write.descriptorCount = 1;
        if (wantsBuffer) {
            BufferState& state = *graph_.resources->buffer(resource);
            if (slot.kind == BindingKind::StorageBuffer) {
                if (state.bytes > vulkan_.properties.limits.maxStorageBufferRange)
                    throw GraphError(
                        where + "'" + name + "' has " + std::to_string(state.bytes) +
                        " bytes, one binding may have " +
                        std::to_string(vulkan_.properties.limits.maxStorageBufferRange));
                write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
                write.pBufferInfo = &bufferInfos.emplace_back(
                    VkDescriptorBufferInfo{state.handle, 0, VK_WHOLE_SIZE});
            } else {
                write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
                write.pTexelBufferView =
                    &views.emplace_back(state.view(texelFormat(slot.imageFormat, kernel)));
            }
            return write;
        }
        ImageState& image = *graph_.resources->image(resource);
        const bool sampled = slot.kind == BindingKind::SampledImage;
        write.descriptorType =
            sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        write.pImageInfo = &imageInfos.emplace_back(VkDescriptorImageInfo{
            sampled ? vulkan_.pipelines->sampler(binding.filter == Filter::Linear) : VK_NULL_HANDLE,
            image.view, infoOf(usage).layout});
        return write;
    }

    RenderGraph::State& graph_;
    VulkanState& vulkan_;
    VkCommandBuffer commands_;
    const PlannedPass* planned_ = nullptr;
};

// Two timestamps a pass, each behind a full barrier: without it the software device reports the
// next pass's time.
class Timer
{
public:
    Timer(VulkanState& vulkan, std::uint32_t passes) : vulkan_(vulkan), count_(passes + 1)
    {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = count_;
        check(vkCreateQueryPool(vulkan.device, &info, nullptr, &pool_), "vkCreateQueryPool");
    }
    ~Timer() { vkDestroyQueryPool(vulkan_.device, pool_, nullptr); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

    void reset(VkCommandBuffer commands) { vkCmdResetQueryPool(commands, pool_, 0, count_); }
    void mark(VkCommandBuffer commands, std::uint32_t index)
    {
        fullBarrier(commands);
        vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, index);
    }
    std::vector<double> milliseconds() const
    {
        std::vector<std::uint64_t> ticks(count_);
        check(vkGetQueryPoolResults(vulkan_.device, pool_, 0, count_, ticks.size() * 8,
                                    ticks.data(), 8,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "vkGetQueryPoolResults");
        std::vector<double> out;
        for (std::uint32_t i = 0; i + 1 < count_; ++i)
            out.push_back(double(ticks[i + 1] - ticks[i]) *
                          vulkan_.properties.limits.timestampPeriod * 1e-6);
        return out;
    }

private:
    VulkanState& vulkan_;
    std::uint32_t count_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
};

} // namespace

void executeGraph(RenderGraph::State& graph)
{
    VulkanState& vulkan = graph.context->vulkan();
    const std::vector<PlannedPass>& passes = graph.plan->passes;
    std::unique_ptr<Timer> timer;
    if (graph.timingsEnabled)
        timer = std::make_unique<Timer>(vulkan, std::uint32_t(passes.size()));
    vulkan.submit([&](VkCommandBuffer commands) {
        Recorder recorder(graph, commands);
        if (timer) {
            timer->reset(commands);
            timer->mark(commands, 0);
        }
        for (std::uint32_t i = 0; i < passes.size(); ++i) {
            recorder.recordPass(passes[i]);
            if (timer)
                timer->mark(commands, i + 1);
        }
        // Results are read on the host, and the next submit may reuse everything.
        fullBarrier(commands);
    });
    graph.timings.clear();
    if (!timer)
        return;
    const std::vector<double> milliseconds = timer->milliseconds();
    for (std::uint32_t i = 0; i < passes.size(); ++i)
        graph.timings.push_back({graph.description.passes[passes[i].pass].name, milliseconds[i]});
}

} // namespace strandlight
