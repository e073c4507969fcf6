#include "engine/graph/descriptor_writes.hpp"

#include "engine/base/error.hpp"
#include "engine/graph/usage_info.hpp"
#include "engine/vk/pipeline_store.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace {

struct TexelFormat
{
    VkFormat format;
    std::uint32_t bytes;
};

TexelFormat texelFormat(std::uint32_t spirvFormat, const std::string& where)
{
    switch (spirvFormat) { // SPIR-V 1.6, 3.11 Image Format
    case 1:
        return {VK_FORMAT_R32G32B32A32_SFLOAT, 16};
    case 2:
        return {VK_FORMAT_R16G16B16A16_SFLOAT, 8};
    case 3:
        return {VK_FORMAT_R32_SFLOAT, 4};
    case 6:
        return {VK_FORMAT_R32G32_SFLOAT, 8};
    case 9:
        return {VK_FORMAT_R16_SFLOAT, 2};
    case 30:
        return {VK_FORMAT_R32G32B32A32_UINT, 16};
    case 33:
        return {VK_FORMAT_R32_UINT, 4};
    case 35:
        return {VK_FORMAT_R32G32_UINT, 8};
    default:
        throw GraphError(where + ": a texel buffer needs the format r16f, rgba16f, r32f, rg32f, "
                                 "rgba32f, r32ui, rg32ui or rgba32ui");
    }
}

} // namespace

DescriptorWrites::DescriptorWrites(RenderGraph::State& graph, std::uint32_t pass,
                                   const char* kernel, const Reflection& reflection,
                                   const std::vector<Binding>& bindings)
    : graph_(graph), pass_(graph.description.passes[pass])
{
    for (const ReflectedBinding& slot : reflection.bindings) {
        where_ = "pass '" + pass_.name + "', kernel " + kernel + ", binding " +
                 std::to_string(slot.binding);
        if (slot.binding >= bindings.size())
            throw GraphError(where_ + " (" + toString(slot.kind) + ") is not given");
        add(slot, bindings[slot.binding]);
    }
}

void DescriptorWrites::push(VkCommandBuffer commands, VkPipelineBindPoint point,
                            VkPipelineLayout layout) const
{
    if (!writes_.empty())
        vkCmdPushDescriptorSetKHR(commands, point, layout, 0, std::uint32_t(writes_.size()),
                                  writes_.data());
}

Usage DescriptorWrites::declaredUsage(std::uint32_t resource) const
{
    for (const UseDescription& use : pass_.uses)
        if (use.resource == resource)
            return use.usage;
    const bool known = resource < graph_.description.resources.size();
    throw GraphError(where_ + ": the pass does not declare " +
                     (known ? "'" + graph_.description.resources[resource].name + "'"
                            : "what is bound, a handle that no create or import returned"));
}

void DescriptorWrites::add(const ReflectedBinding& slot, const Binding& binding)
{
    const bool isBuffer = std::holds_alternative<BufferId>(binding.resource);
    const std::uint32_t resource = isBuffer ? std::get<BufferId>(binding.resource).index
                                            : std::get<ImageId>(binding.resource).index;
    const bool wantsBuffer =
        slot.kind == BindingKind::StorageBuffer || slot.kind == BindingKind::StorageTexelBuffer;
    const Usage usage = declaredUsage(resource);
    const std::string& name = graph_.description.resources[resource].name;
    if (isBuffer != wantsBuffer ||
        (slot.kind == BindingKind::SampledImage) != (usage == Usage::Sample))
        throw GraphError(where_ + ": the shader wants a " + toString(slot.kind) + ", '" + name +
                         "' is used as " + toString(usage));
    if (!slot.readOnly && usage == Usage::ShaderRead)
        throw GraphError(
            where_ + ": the shader may write '" + name +
            "', the pass only reads it (say `readonly` in the shader, or write() in the pass)");

    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = slot.binding;
    write.descriptorCount = 1;
    if (wantsBuffer) {
        addBuffer(slot, *graph_.resources->buffer(resource), binding, write);
    } else {
        const bool sampled = slot.kind == BindingKind::SampledImage;
        PipelineStore& pipelines = *graph_.context->vulkan().pipelines;
        write.descriptorType =
            sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        write.pImageInfo = &images_.emplace_back(VkDescriptorImageInfo{
            sampled ? pipelines.sampler(binding.filter == Filter::Linear) : VK_NULL_HANDLE,
            graph_.resources->image(resource)->view, infoOf(usage).layout});
    }
    writes_.push_back(write);
}

void DescriptorWrites::addBuffer(const ReflectedBinding& slot, BufferState& buffer,
                                 const Binding& binding, VkWriteDescriptorSet& write)
{
    const VkPhysicalDeviceLimits& limits = graph_.context->vulkan().properties.limits;
    if (binding.offset % Binding::kAlignment != 0 || binding.offset > buffer.bytes ||
        binding.bytes > buffer.bytes - binding.offset)
        throw GraphError(where_ + ": bytes " + std::to_string(binding.offset) + " and " +
                         std::to_string(binding.bytes) + " more of '" + buffer.name +
                         "' are out of line or beyond its " + std::to_string(buffer.bytes));
    const std::uint64_t bytes = binding.bytes ? binding.bytes : buffer.bytes - binding.offset;
    const auto checkLimit = [&](std::uint64_t limit) {
        if (bytes > limit)
            throw GraphError(where_ + ": '" + buffer.name + "' has " + std::to_string(bytes) +
                             " bytes, one " + toString(slot.kind) + " may have " +
                             std::to_string(limit));
    };
    if (slot.kind == BindingKind::StorageBuffer) {
        checkLimit(limits.maxStorageBufferRange);
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &buffers_.emplace_back(VkDescriptorBufferInfo{
            buffer.handle, binding.offset, binding.bytes ? binding.bytes : VK_WHOLE_SIZE});
        return;
    }
    const TexelFormat texel = texelFormat(slot.imageFormat, where_);
    checkLimit(std::uint64_t(limits.maxTexelBufferElements) * texel.bytes);
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    write.pTexelBufferView =
        &views_.emplace_back(buffer.view(texel.format, binding.offset, binding.bytes));
}

} // namespace strandlight
