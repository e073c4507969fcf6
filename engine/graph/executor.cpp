#include "engine/graph/executor.hpp"

#include <exception>
#include <memory>

#include "engine/graph/pass_recorder.hpp"
#include "engine/graph/pass_timer.hpp"
#include "engine/vk/vulkan_state.hpp"

namespace strandlight {

namespace {

// Recording follows the images' layouts. What throws before it is submitted has changed none of
// them: an import must come out of it usable.
class LayoutGuard
{
public:
    explicit LayoutGuard(const GraphResources& resources) : thrown_(std::uncaught_exceptions())
    {
        for (std::uint32_t i = 0; i < resources.count(); ++i)
            if (ImageState* image = resources.image(i))
                before_.emplace_back(image, image->layout);
    }
    ~LayoutGuard()
    {
        if (std::uncaught_exceptions() > thrown_)
            for (const auto& [image, layout] : before_)
                image->layout = layout;
    }
    LayoutGuard(const LayoutGuard&) = delete;
    LayoutGuard& operator=(const LayoutGuard&) = delete;

private:
    int thrown_;
    std::vector<std::pair<ImageState*, VkImageLayout>> before_;
};

} // namespace

void executeGraph(RenderGraph::State& graph)
{
    VulkanState& vulkan = graph.context->vulkan();
    const std::vector<PlannedPass>& passes = graph.plan->passes;
    std::unique_ptr<PassTimer> timer;
    const bool byPass = graph.timed == Timings::Passes;
    if (graph.timed != Timings::None)
        timer = std::make_unique<PassTimer>(vulkan, byPass ? std::uint32_t(passes.size()) : 1);
    vulkan.submit([&](VkCommandBuffer commands) {
        const LayoutGuard layouts(*graph.resources);
        PassRecorder recorder(graph, commands);
        if (timer) {
            timer->reset(commands);
            timer->mark(commands, 0);
        }
        for (std::uint32_t i = 0; i < passes.size(); ++i) {
            recorder.recordPass(passes[i]);
            if (byPass)
                timer->mark(commands, i + 1);
        }
        if (graph.timed == Timings::Whole)
            timer->mark(commands, 1);
        // Results are read on the host, and the next submit may reuse everything.
        fullBarrier(commands);
    });
    graph.timings.clear();
    if (!timer)
        return;
    const std::vector<double> milliseconds = timer->milliseconds();
    for (std::uint32_t i = 0; i < milliseconds.size(); ++i)
        graph.timings.push_back(
            {byPass ? graph.description.passes[passes[i].pass].name : "graph", milliseconds[i]});
}

} // namespace strandlight
