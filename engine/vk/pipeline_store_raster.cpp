// The raster half of PipelineStore.
#include "engine/vk/pipeline_store.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "engine/base/error.hpp"
#include "engine/vk/check.hpp"
#include "engine/vk/image_formats.hpp"
#include "engine/vk/specialization.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace {

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

VkPipelineColorBlendAttachmentState blendOf(Blend mode)
{
    VkPipelineColorBlendAttachmentState blend{};
    blend.colorWriteMask = 0xF;
    blend.blendEnable = mode != Blend::None;
    blend.srcColorBlendFactor =
        mode == Blend::Multiply ? VK_BLEND_FACTOR_ZERO : VK_BLEND_FACTOR_ONE;
    blend.dstColorBlendFactor =
        mode == Blend::Multiply ? VK_BLEND_FACTOR_SRC_COLOR : VK_BLEND_FACTOR_ONE;
    blend.srcAlphaBlendFactor =
        mode == Blend::Multiply ? VK_BLEND_FACTOR_ZERO : VK_BLEND_FACTOR_ONE;
    blend.dstAlphaBlendFactor =
        mode == Blend::Multiply ? VK_BLEND_FACTOR_SRC_ALPHA : VK_BLEND_FACTOR_ONE;
    return blend;
}

} // namespace

const Pipeline& PipelineStore::raster(const RasterDesc& desc, const RasterTargets& targets)
{
    RasterKey key{desc.vertex, desc.fragment, desc.constants, targets};
    key.state.insert(key.state.end(),
                     {std::uint32_t(desc.topology), desc.depthTest, desc.depthWrite, desc.cullBack,
                      std::uint32_t(desc.blend), desc.alphaToCoverage});
    if (const auto found = raster_.find(key); found != raster_.end())
        return found->second;
    Pipeline pipeline;
    pipeline.reflection =
        merge(reflect(*desc.vertex), reflect(*desc.fragment), desc.fragment->name);
    pipeline.stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    const auto destroyModules = [&] {
        for (const VkPipelineShaderStageCreateInfo& stage : stages)
            vkDestroyShaderModule(state_.device, stage.module, nullptr);
    };
    try {
        createLayout(pipeline);
        const Specialization special(desc.constants);
        for (std::size_t i = 0; i < stages.size(); ++i) {
            stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
            stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
            stages[i].module = createModule(i == 0 ? *desc.vertex : *desc.fragment);
            stages[i].pName = "main";
            stages[i].pSpecializationInfo = &special.info();
        }
        createRaster(pipeline, desc, targets, stages);
    } catch (...) { // a half-made pipeline must not be found by the next call
        destroyModules();
        destroy(pipeline);
        throw;
    }
    destroyModules();
    ++created_;
    return raster_.emplace(std::move(key), std::move(pipeline)).first->second;
}

void PipelineStore::createRaster(Pipeline& pipeline, const RasterDesc& desc,
                                 const RasterTargets& targets,
                                 std::span<const VkPipelineShaderStageCreateInfo> stages) const
{
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
    multisample.alphaToCoverageEnable = desc.alphaToCoverage;
    VkPipelineDepthStencilStateCreateInfo depth{
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = targets.depth && desc.depthTest;
    depth.depthWriteEnable = targets.depth && desc.depthWrite;
    depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    const std::vector<VkPipelineColorBlendAttachmentState> blends(targets.colors.size(),
                                                                  blendOf(desc.blend));
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
    info.stageCount = std::uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &vertexInput;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blending;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout;
    check(vkCreateGraphicsPipelines(state_.device, cache_, 1, &info, nullptr, &pipeline.handle),
          desc.fragment->name);
    state_.nameObject(VK_OBJECT_TYPE_PIPELINE, std::uint64_t(pipeline.handle), desc.fragment->name);
}

} // namespace strandlight
