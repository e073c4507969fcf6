// Every pipeline of a context, made on first use and kept; VkPipelineCache on disk between runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <volk.h>

#include "engine/vk/image_desc.hpp"
#include "engine/vk/raster_pipeline.hpp"
#include "engine/vk/reflect.hpp"

namespace strandlight {

struct VulkanState;

struct Pipeline
{
    VkPipeline handle = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    Reflection reflection; // of all stages together
    VkShaderStageFlags stages = 0;
};

// Formats a raster pipeline draws into.
struct RasterTargets
{
    std::vector<Format> colors;
    bool depth = false;
    std::uint32_t samples = 1;
    friend auto operator<=>(const RasterTargets&, const RasterTargets&) = default;
};

class PipelineStore
{
public:
    PipelineStore(VulkanState& state, bool onDisk);
    ~PipelineStore(); // saves the cache when something new was compiled
    PipelineStore(const PipelineStore&) = delete;
    PipelineStore& operator=(const PipelineStore&) = delete;

    const Pipeline& compute(const KernelBlob& kernel, std::span<const std::uint32_t> constants);
    const Pipeline& raster(const RasterDesc& desc, const RasterTargets& targets);
    VkSampler sampler(bool linear);
    std::uint32_t created() const { return created_; }

private:
    struct RasterKey
    {
        const KernelBlob* vertex;
        const KernelBlob* fragment;
        std::vector<std::uint32_t> state;
        RasterTargets targets;
        friend auto operator<=>(const RasterKey&, const RasterKey&) = default;
    };
    using ComputeKey = std::pair<const KernelBlob*, std::vector<std::uint32_t>>;

    void createLayout(Pipeline& pipeline) const;
    void createCompute(Pipeline& pipeline, const KernelBlob& kernel,
                       std::span<const std::uint32_t> constants) const;
    void createRaster(Pipeline& pipeline, const RasterDesc& desc, const RasterTargets& targets,
                      std::span<const VkPipelineShaderStageCreateInfo> stages) const;
    VkShaderModule createModule(const KernelBlob& kernel) const;
    void destroy(Pipeline& pipeline) const;

    VulkanState& state_;
    std::filesystem::path file_; // empty: not on disk
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::size_t loadedBytes_ = 0;
    std::uint32_t created_ = 0;
    VkSampler samplers_[2] = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    std::map<ComputeKey, Pipeline> compute_;
    std::map<RasterKey, Pipeline> raster_;
};

} // namespace strandlight
