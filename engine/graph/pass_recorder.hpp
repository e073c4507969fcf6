// One pass of a plan into a command buffer: barriers, attachments, commands.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/graph/executor.hpp"

namespace strandlight {

struct Pipeline;
struct VulkanState;

class PassRecorder
{
public:
    PassRecorder(RenderGraph::State& graph, VkCommandBuffer commands);

    // Follows the images' layouts. Throws GraphError where commands do not fit their shaders.
    void recordPass(const PlannedPass& planned);

private:
    const std::string& passName() const;
    void recordBarriers(const PlannedPass& planned);
    void beginRendering(const PassCommands& pass);
    void record(const PassCommands& pass, const DispatchCommand& command);
    void record(const PassCommands& pass, const DrawCommand& command);
    void record(const PassCommands& pass, const FillCommand& command);
    void record(const PassCommands& pass, const CopyCommand& command);
    void bind(const Pipeline& pipeline, VkPipelineBindPoint point, const char* kernel,
              const std::vector<Binding>& bindings, const std::vector<std::byte>& push);

    RenderGraph::State& graph_;
    VulkanState& vulkan_;
    VkCommandBuffer commands_;
    const PlannedPass* planned_ = nullptr;
};

} // namespace strandlight
