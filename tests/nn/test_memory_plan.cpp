// Activations and gradients of a training step share memory where their lives do not meet.
#include <doctest/doctest.h>

#include "compute_nn/unet.hpp"
#include "engine/graph/plan.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

TEST_CASE("a training step's transients are aliased, and never while both are needed")
{
    const UNetDesc net = benchmarkUNet();
    const TensorDesc x{1, net.in, 96, 160}, y{1, net.out, 96, 160};
    Parameters parameters(context(), net.parameters(), 1);
    RenderGraph graph(context());
    ParameterIds ids(graph, parameters);
    const std::vector<float> zeros(x.elements(), 0.0f);
    addUNetTrainingStep(graph, net, ids, uploadTensor(graph, "x", x, zeros),
                        uploadTensor(graph, "target", y, std::span(zeros).first(y.elements())), {},
                        1);
    const GraphPlan& plan = graph.compile();
    INFO(memoryText(plan));
    // Forward activations must live until their layer's backward pass; gradients and partial sums
    // need not.
    CHECK_LT(plan.arenaBytes, plan.transientBytes * 9 / 10);
    CHECK_NE(memoryText(plan).find("sharing memory"), std::string::npos);

    for (std::uint32_t a = 0; a < plan.resources.size(); ++a)
        for (std::uint32_t b = 0; b < a; ++b) {
            const PlannedResource &p = plan.resources[a], &q = plan.resources[b];
            const bool bothLive = p.aliased && q.aliased && p.used && q.used &&
                                  p.firstPass <= q.lastPass && q.firstPass <= p.lastPass;
            const bool overlap = p.offset < q.offset + plan.description.resources[b].bytes() &&
                                 q.offset < p.offset + plan.description.resources[a].bytes();
            CHECK_FALSE((bothLive && overlap));
        }
}
