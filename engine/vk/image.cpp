#include "engine/vk/image.hpp"

#include <cstring>
#include <utility>
#include <vector>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "engine/vk/buffer.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/context.hpp"
#include "engine/vk/image_formats.hpp"
#include "engine/vk/resource_state.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace {

VkImageUsageFlags usageOf(const ImageDesc& desc)
{
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (desc.format == Format::Depth32F)
        return usage | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    return desc.samples == 1 ? usage | VK_IMAGE_USAGE_STORAGE_BIT : usage;
}

void transition(VkCommandBuffer commands, ImageState& state, VkImageLayout layout)
{
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = state.layout;
    barrier.newLayout = layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = state.handle;
    barrier.subresourceRange = {aspectOf(state.desc.format), 0, 1, 0, state.desc.layers};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
    state.layout = layout;
}

VkBufferImageCopy layerRegion(const ImageDesc& desc, std::uint32_t layer)
{
    VkBufferImageCopy region{};
    region.imageSubresource = {aspectOf(desc.format), 0, layer, 1};
    region.imageExtent = {desc.width, desc.height, 1};
    return region;
}

} // namespace

ImageState::~ImageState()
{
    if (view)
        vkDestroyImageView(vulkan->device, view, nullptr);
    if (handle)
        vkDestroyImage(vulkan->device, handle, nullptr);
}

void createImageHandle(VulkanState& vulkan, ImageState& state)
{
    const ImageDesc& desc = state.desc;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = toVulkan(desc.format);
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = desc.layers;
    info.samples = VkSampleCountFlagBits(desc.samples);
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usageOf(desc);
    VkImageFormatProperties limits{};
    const VkResult supported = vkGetPhysicalDeviceImageFormatProperties(
        vulkan.physical, info.format, info.imageType, info.tiling, info.usage, 0, &limits);
    if (supported != VK_SUCCESS || desc.width > limits.maxExtent.width ||
        desc.height > limits.maxExtent.height || desc.layers > limits.maxArrayLayers ||
        !(limits.sampleCounts & desc.samples))
        throw VulkanError("image '" + state.name + "': the device has no " +
                          std::to_string(desc.width) + "x" + std::to_string(desc.height) + "x" +
                          std::to_string(desc.layers) + " " + toString(desc.format) +
                          " image with " + std::to_string(desc.samples) + " samples");
    check(vkCreateImage(vulkan.device, &info, nullptr, &state.handle), "vkCreateImage");
    vulkan.nameObject(VK_OBJECT_TYPE_IMAGE, std::uint64_t(state.handle), state.name);
}

void createImageView(ImageState& state)
{
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = state.handle;
    info.viewType = state.desc.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    info.format = toVulkan(state.desc.format);
    info.subresourceRange = {aspectOf(state.desc.format), 0, 1, 0, state.desc.layers};
    check(vkCreateImageView(state.vulkan->device, &info, nullptr, &state.view),
          "vkCreateImageView");
}

Image::Image(Context& context, const ImageDesc& desc, std::string name)
    : state_(std::make_unique<ImageState>())
{
    VulkanState& vulkan = context.vulkan();
    state_->vulkan = &vulkan;
    state_->name = std::move(name);
    state_->desc = desc;
    createImageHandle(vulkan, *state_);
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(vulkan.device, state_->handle, &needs);
    state_->memory = vulkan.allocator->allocate(needs, MemoryUse::Device, state_->name);
    check(vkBindImageMemory(vulkan.device, state_->handle, state_->memory.memory(),
                            state_->memory.offset()),
          "vkBindImageMemory");
    createImageView(*state_);
    vulkan.submit([&](VkCommandBuffer commands) {
        transition(commands, *state_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkImageSubresourceRange all{aspectOf(desc.format), 0, 1, 0, desc.layers};
        if (desc.format == Format::Depth32F) {
            const VkClearDepthStencilValue far{1.0f, 0};
            vkCmdClearDepthStencilImage(commands, state_->handle, state_->layout, &far, 1, &all);
        } else {
            const VkClearColorValue zero{};
            vkCmdClearColorImage(commands, state_->handle, state_->layout, &zero, 1, &all);
        }
        fullBarrier(commands);
    });
}

Image::Image() noexcept = default;
Image::Image(Image&&) noexcept = default;
Image& Image::operator=(Image&&) noexcept = default;
Image::~Image() = default;

const ImageDesc& Image::desc() const
{
    return state_->desc;
}
const std::string& Image::name() const
{
    return state_->name;
}

void Image::upload(const CpuImage& pixels, std::uint32_t layer)
{
    const ImageDesc& desc = state_->desc;
    STRANDLIGHT_ASSERT(pixels.width == desc.width && pixels.height == desc.height &&
                       layer < desc.layers);
    const std::uint32_t stride = bytesPerPixel(desc.format);
    std::vector<std::byte> bytes(pixels.pixels.size() * stride);
    for (std::size_t i = 0; i < pixels.pixels.size(); ++i)
        encodePixel(desc.format, pixels.pixels[i], bytes.data() + i * stride);

    VulkanState& vulkan = *state_->vulkan;
    Staging staging(vulkan, bytes.size());
    std::memcpy(staging.mapped(), bytes.data(), bytes.size());
    vulkan.submit([&](VkCommandBuffer commands) {
        transition(commands, *state_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        const VkBufferImageCopy region = layerRegion(desc, layer);
        vkCmdCopyBufferToImage(commands, staging.state.handle, state_->handle, state_->layout, 1,
                               &region);
        fullBarrier(commands);
    });
}

std::vector<std::byte> downloadLayer(ImageState& state, std::uint32_t layer)
{
    STRANDLIGHT_ASSERT(layer < state.desc.layers && state.desc.samples == 1);
    VulkanState& vulkan = *state.vulkan;
    Staging staging(vulkan, state.desc.bytes() / state.desc.layers);
    vulkan.submit([&](VkCommandBuffer commands) {
        transition(commands, state, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        const VkBufferImageCopy region = layerRegion(state.desc, layer);
        vkCmdCopyImageToBuffer(commands, state.handle, state.layout, staging.state.handle, 1,
                               &region);
        fullBarrier(commands);
    });
    return {staging.mapped(), staging.mapped() + staging.state.bytes};
}

CpuImage toCpuImage(const ImageDesc& desc, const std::vector<std::byte>& bytes)
{
    CpuImage out(desc.width, desc.height);
    const std::uint32_t stride = bytesPerPixel(desc.format);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = decodePixel(desc.format, bytes.data() + i * stride);
    return out;
}

CpuImage Image::download(std::uint32_t layer) const
{
    return toCpuImage(state_->desc, downloadLayer(*state_, layer));
}

} // namespace strandlight
