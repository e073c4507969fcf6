#include "engine/vk/pipeline_store.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/log.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/image_formats.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kPushBytes = 128; // the least that Vulkan promises, and what lavapipe has

fs::path cacheFile(const VkPhysicalDeviceProperties& properties)
{
    const char* xdg = std::getenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    if (!xdg && !home)
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
    const fs::path folder =
        (xdg && *xdg ? fs::path(xdg) : fs::path(home) / ".cache") / "strandlight";
    return folder / ("pipelines-" + uuid + "-" + std::to_string(name) + ".bin");
}

VkSpecializationInfo specialization(std::span<const std::uint32_t> constants,
                                    std::vector<VkSpecializationMapEntry>& entries)
{
    entries.clear();
    for (std::uint32_t i = 0; i < constants.size(); ++i)
        entries.push_back({i, i * 4, 4});
    return {std::uint32_t(entries.size()), entries.data(), constants.size_bytes(),
            constants.data()};
}

VkDescriptorType toVulkan(BindingKind kind)
{
    static const VkDescriptorType kTypes[] = {
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    return kTypes[std::size_t(kind)];
}

// Both stages see one set of bindings; a binding that both declare must agree.
Reflection merge(const Reflection& a, const Reflection& b, const char* name)
{
    Reflection out = a;
    out.pushBytes = std::max(a.pushBytes, b.pushBytes);
    for (const ReflectedBinding& binding : b.bindings) {
        const auto same = std::find_if(out.bindings.begin(), out.bindings.end(),
                                       [&](const auto& o) { return o.binding == binding.binding; });
        if (same == out.bindings.end()) {
            out.bindings.push_back(binding);
        } else {
            if (same->kind != binding.kind)
                throw Error(std::string("shader ") + name + ", binding " +
                            std::to_string(binding.binding) +
                            ": the two stages declare different kinds");
            same->readOnly = same->readOnly && binding.readOnly;
        }
    }
    std::sort(out.bindings.begin(), out.bindings.end(),
              [](const auto& x, const auto& y) { return x.binding < y.binding; });
    return out;
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
        if (bytes > loadedBytes_ &&
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

void PipelineStore::destroy(Pipeline& pipeline)
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

void PipelineStore::createLayout(Pipeline& pipeline)
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
    Pipeline& pipeline = compute_[key];
    pipeline.reflection = reflect(kernel);
    pipeline.stages = VK_SHADER_STAGE_COMPUTE_BIT;
    createLayout(pipeline);
    std::vector<VkSpecializationMapEntry> entries;
    const VkSpecializationInfo special = specialization(constants, entries);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = createModule(kernel);
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &special;
    info.layout = pipeline.layout;
    const VkResult result =
        vkCreateComputePipelines(state_.device, cache_, 1, &info, nullptr, &pipeline.handle);
    vkDestroyShaderModule(state_.device, info.stage.module, nullptr);
    check(result, kernel.name);
    state_.nameObject(VK_OBJECT_TYPE_PIPELINE, std::uint64_t(pipeline.handle), kernel.name);
    ++created_;
    return pipeline;
}

const Pipeline& PipelineStore::raster(const RasterDesc& desc, const RasterTargets& targets)
{
    RasterKey key{desc.vertex, desc.fragment, desc.constants, targets};
    key.state.insert(key.state.end(), {std::uint32_t(desc.topology), desc.depthTest,
                                       desc.depthWrite, desc.cullBack, std::uint32_t(desc.blend)});
    if (const auto found = raster_.find(key); found != raster_.end())
        return found->second;
    Pipeline& pipeline = raster_[key];
    pipeline.reflection =
        merge(reflect(*desc.vertex), reflect(*desc.fragment), desc.fragment->name);
    pipeline.stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    createLayout(pipeline);

    std::vector<VkSpecializationMapEntry> entries;
    const VkSpecializationInfo special = specialization(desc.constants, entries);
    VkPipelineShaderStageCreateInfo stages[2] = {};
    for (int i = 0; i < 2; ++i) {
        stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
        stages[i].module = createModule(i == 0 ? *desc.vertex : *desc.fragment);
        stages[i].pName = "main";
        stages[i].pSpecializationInfo = &special;
    }
    const VkPipelineVertexInputStateCreateInfo vertexInput{
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = desc.topology == Topology::Lines ? VK_PRIMITIVE_TOPOLOGY_LINE_LIST
                                                         : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.cullMode = desc.cullBack ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo multisample{
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VkSampleCountFlagBits(targets.samples);
    VkPipelineDepthStencilStateCreateInfo depth{
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = targets.depth && desc.depthTest;
    depth.depthWriteEnable = targets.depth && desc.depthWrite;
    depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    VkPipelineColorBlendAttachmentState blend{};
    blend.colorWriteMask = 0xF;
    blend.blendEnable = desc.blend != Blend::None;
    blend.srcColorBlendFactor =
        desc.blend == Blend::Multiply ? VK_BLEND_FACTOR_ZERO : VK_BLEND_FACTOR_ONE;
    blend.dstColorBlendFactor =
        desc.blend == Blend::Multiply ? VK_BLEND_FACTOR_SRC_COLOR : VK_BLEND_FACTOR_ONE;
    blend.srcAlphaBlendFactor =
        desc.blend == Blend::Multiply ? VK_BLEND_FACTOR_ZERO : VK_BLEND_FACTOR_ONE;
    blend.dstAlphaBlendFactor =
        desc.blend == Blend::Multiply ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
    const std::vector<VkPipelineColorBlendAttachmentState> blends(targets.colors.size(), blend);
    VkPipelineColorBlendStateCreateInfo blending{
        VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blending.attachmentCount = std::uint32_t(blends.size());
    blending.pAttachments = blends.data();
    const VkDynamicState dynamics[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamics;
    std::vector<VkFormat> formats;
    for (const Format format : targets.colors)
        formats.push_back(toVulkan(format));
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = std::uint32_t(formats.size());
    rendering.pColorAttachmentFormats = formats.data();
    rendering.depthAttachmentFormat = targets.depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blending;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout;
    const VkResult result =
        vkCreateGraphicsPipelines(state_.device, cache_, 1, &info, nullptr, &pipeline.handle);
    for (const auto& stage : stages)
        vkDestroyShaderModule(state_.device, stage.module, nullptr);
    check(result, desc.fragment->name);
    ++created_;
    return pipeline;
}

} // namespace strandlight
