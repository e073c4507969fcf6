#include "passes/stress/closed_forms.hpp"

#include "engine/graph/render_graph.hpp"
#include "kernels/stress.gen.hpp"

namespace strandlight {

std::vector<gpu::StressOutput> stressOnDevice(Context& context, std::uint32_t function,
                                              std::span<const gpu::StressInput> items)
{
    RenderGraph graph(context);
    const auto count = std::uint32_t(items.size());
    PassBuilder pass = graph.addComputePass("stress");
    const BufferId from = pass.read(graph.uploadBuffer("items", items));
    const BufferId to =
        pass.write(graph.createBuffer("results", items.size() * sizeof(gpu::StressOutput)));
    pass.dispatch(kernels::stress_functions, {count, 1, 1}, count, {from, to}, {function});
    graph.output(to);
    graph.run();
    return graph.read<gpu::StressOutput>(to);
}

std::vector<gpu::StressOutput> stressInCpp(std::uint32_t function,
                                           std::span<const gpu::StressInput> items)
{
    std::vector<gpu::StressOutput> results;
    results.reserve(items.size());
    for (const gpu::StressInput& item : items)
        results.push_back(function >= gpu::kStressFunctions ? gpu::stressPacking(function, item)
                                                            : gpu::stressFunction(function, item));
    return results;
}

} // namespace strandlight
