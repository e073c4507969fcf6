#include "engine/vk/pipeline_store.hpp"

#include <cstdio>
#include <string>

#include "engine/base/cache_folder.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/log.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/specialization.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kPushBytes = 128; // the least that Vulkan promises, and what lavapipe has

fs::path cacheFile(const VkPhysicalDeviceProperties& properties)
{
    const fs::path folder = cacheFolder();
    if (folder.empty())
        return {};
    std::string uuid;
    for (const std::uint8_t byte : properties.pipelineCacheUUID) {
        char text[3];
        std::snprintf(text, sizeof(text), "%02x", byte);
        uuid += text;
    }
    // The device name carries the vector width of lavapipe, which its cache key forgets.
    const std::uint32_t name =
        crc32(std::span(reinterpret_cast<const std::uint8_t*>(properties.deviceName),
                        std::string_view(properties.deviceName).size()));
    return folder / ("pipelines-" + uuid + "-" + std::to_string(name) + ".bin");
}

VkDescriptorType toVulkan(BindingKind kind)
{
    static const VkDescriptorType kTypes[] = {
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    return kTypes[std::size_t(kind)];
}

} // namespace

PipelineStore::PipelineStore(VulkanState& state, bool onDisk) : state_(state)
{
    std::vector<std::uint8_t> initial;
    if (onDisk)
        file_ = cacheFile(state.properties);
    std::error_code error;
    if (!file_.empty() && fs::exists(file_, error)) {
        try {
            initial = readFile(file_, std::uint64_t(256) << 20);
        } catch (const FileError& e) {
            logDebug(e.what()); // a cache that cannot be read is an empty cache
        }
    }
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = initial.size();
    info.pInitialData = initial.data();
    check(vkCreatePipelineCache(state.device, &info, nullptr, &cache_), "vkCreatePipelineCache");
    loadedBytes_ = initial.size();
}

PipelineStore::~PipelineStore()
{
    if (!file_.empty() && created_ != 0) {
        std::size_t bytes = 0;
        vkGetPipelineCacheData(state_.device, cache_, &bytes, nullptr);
        std::vector<std::uint8_t> data(bytes);
        // Other than what was loaded: something is new, or the driver has refused the old data.
        if (bytes != loadedBytes_ &&
            vkGetPipelineCacheData(state_.device, cache_, &bytes, data.data()) == VK_SUCCESS) {
            try {
                fs::create_directories(file_.parent_path());
                writeFileAtomically(file_, data);
            } catch (const std::exception& e) {
                logDebug(e.what()); // losing the cache costs time, nothing else
            }
        }
    }
    for (auto& [key, pipeline] : compute_)
        destroy(pipeline);
    for (auto& [key, pipeline] : raster_)
        destroy(pipeline);
    for (VkSampler sampler : samplers_)
        vkDestroySampler(state_.device, sampler, nullptr);
    vkDestroyPipelineCache(state_.device, cache_, nullptr);
}

void PipelineStore::destroy(Pipeline& pipeline) const
{
    vkDestroyPipeline(state_.device, pipeline.handle, nullptr);
    vkDestroyPipelineLayout(state_.device, pipeline.layout, nullptr);
    vkDestroyDescriptorSetLayout(state_.device, pipeline.setLayout, nullptr);
}

VkSampler PipelineStore::sampler(bool linear)
{
    VkSampler& sampler = samplers_[linear ? 1 : 0];
    if (!sampler) {
        VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
        info.magFilter = info.minFilter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
        info.addressModeU = info.addressModeV = info.addressModeW =
            VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        info.maxLod = VK_LOD_CLAMP_NONE;
        check(vkCreateSampler(state_.device, &info, nullptr, &sampler), "vkCreateSampler");
    }
    return sampler;
}

VkShaderModule PipelineStore::createModule(const KernelBlob& kernel) const
{
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = kernel.wordCount * 4;
    info.pCode = kernel.words;
    VkShaderModule module = VK_NULL_HANDLE;
    check(vkCreateShaderModule(state_.device, &info, nullptr, &module), kernel.name);
    return module;
}

void PipelineStore::createLayout(Pipeline& pipeline) const
{
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ReflectedBinding& b : pipeline.reflection.bindings)
        bindings.push_back({b.binding, toVulkan(b.kind), 1, pipeline.stages, nullptr});
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    set.bindingCount = std::uint32_t(bindings.size());
    set.pBindings = bindings.data();
    check(vkCreateDescriptorSetLayout(state_.device, &set, nullptr, &pipeline.setLayout),
          "vkCreateDescriptorSetLayout");
    const VkPushConstantRange push{pipeline.stages, 0, kPushBytes};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &pipeline.setLayout;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(state_.device, &layout, nullptr, &pipeline.layout),
          "vkCreatePipelineLayout");
}

const Pipeline& PipelineStore::compute(const KernelBlob& kernel,
                                       std::span<const std::uint32_t> constants)
{
    const ComputeKey key{&kernel, {constants.begin(), constants.end()}};
    if (const auto found = compute_.find(key); found != compute_.end())
        return found->second;
    Pipeline pipeline;
    pipeline.reflection = reflect(kernel);
    pipeline.stages = VK_SHADER_STAGE_COMPUTE_BIT;
    try {
        createLayout(pipeline);
        createCompute(pipeline, kernel, constants);
    } catch (...) { // a half-made pipeline must not be found by the next call
        destroy(pipeline);
        throw;
    }
    ++created_;
    return compute_.emplace(key, std::move(pipeline)).first->second;
}

void PipelineStore::createCompute(Pipeline& pipeline, const KernelBlob& kernel,
                                  std::span<const std::uint32_t> constants) const
{
    const Specialization special(constants);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = createModule(kernel);
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &special.info();
    info.layout = pipeline.layout;
    const VkResult result =
        vkCreateComputePipelines(state_.device, cache_, 1, &info, nullptr, &pipeline.handle);
    vkDestroyShaderModule(state_.device, info.stage.module, nullptr);
    check(result, kernel.name);
    state_.nameObject(VK_OBJECT_TYPE_PIPELINE, std::uint64_t(pipeline.handle), kernel.name);
}

} // namespace strandlight
