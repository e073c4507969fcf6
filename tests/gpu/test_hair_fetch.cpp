// What the hair filter's fused fetch saves, from the plan of its graph.
#include <algorithm>
#include <array>

#include <doctest/doctest.h>

#include "engine/graph/plan.hpp"
#include "passes/hair_filter.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

constexpr std::uint32_t kWidth = 45, kHeight = 70; // neither is a multiple of 8

} // namespace

TEST_CASE("hair filter: fetched, the input's planes are nowhere in memory")
{
    const UNetDesc net = hairUNet(HairUNetSize::Small);
    Parameters parameters(context(), net.parameters(), 17);
    const ImageDesc desc{kWidth, kHeight, 1, Format::RGBA32F, 1};
    ImageDesc four = desc.with(Format::RGBA16F);
    four.samples = 4;
    Image features(context(), four, "features"), shape(context(), four, "shape");
    Image blended(context(), desc, "blended"), filtered(context(), desc, "filtered");
    Image radiance(context(), desc, "radiance");
    const auto bytes = [&](bool fuse) { // of the largest transient, and of all
        RenderGraph graph(context());
        HairFilterInput input;
        input.samples.features = graph.importImage(features);
        input.samples.shape = graph.importImage(shape);
        input.blended = graph.importImage(blended);
        const ParameterIds weights(graph, parameters);
        addHairFilterPasses(graph, net, weights, input,
                            {graph.importImage(filtered), graph.importImage(radiance)},
                            {.fuseFetch = fuse});
        const GraphPlan& plan = graph.compile();
        std::uint64_t largest = 0;
        for (std::size_t r = 0; r < plan.resources.size(); ++r)
            if (plan.resources[r].used && !plan.description.resources[r].imported)
                largest = std::max(largest, plan.description.resources[r].bytes());
        return std::array{largest, plan.transientBytes};
    };
    const std::uint64_t planes = hairInputDesc(kWidth, kHeight).bytes();
    const auto read = bytes(false), fetched = bytes(true);
    CHECK_GE(read[0], planes); // a range of level 0
    CHECK_LT(fetched[0], planes);
    CHECK_EQ(fetched[1], read[1] - planes);
}
