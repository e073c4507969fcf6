// The bindings of one dispatch or draw as descriptors, checked against the shader and the pass.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "engine/graph/executor.hpp"
#include "engine/vk/reflect.hpp"

namespace strandlight {

class DescriptorWrites
{
public:
    // Throws GraphError naming pass, kernel and binding where kind or direction do not fit, where a
    // binding is missing or undeclared, and where a buffer exceeds the device's limits.
    DescriptorWrites(RenderGraph::State& graph, std::uint32_t pass, const char* kernel,
                     const Reflection& reflection, const std::vector<Binding>& bindings);
    DescriptorWrites(const DescriptorWrites&) = delete; // the writes point into the deques
    DescriptorWrites& operator=(const DescriptorWrites&) = delete;

    void push(VkCommandBuffer commands, VkPipelineBindPoint point, VkPipelineLayout layout) const;

private:
    Usage declaredUsage(std::uint32_t resource) const;
    void add(const ReflectedBinding& slot, const Binding& binding);
    void addBuffer(const ReflectedBinding& slot, BufferState& buffer, const Binding& binding,
                   VkWriteDescriptorSet& write);

    RenderGraph::State& graph_;
    const PassDescription& pass_;
    std::string where_; // for messages
    std::vector<VkWriteDescriptorSet> writes_;
    std::deque<VkDescriptorBufferInfo> buffers_;
    std::deque<VkDescriptorImageInfo> images_;
    std::deque<VkBufferView> views_;
};

} // namespace strandlight
