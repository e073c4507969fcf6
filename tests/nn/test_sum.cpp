// The sum of a buffer against exact sums, on series that plain summation gets wrong.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "compute_nn/reference/sum.hpp"
#include "compute_nn/sum.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

float deviceSum(const std::vector<float>& values, float scale = 1.0f)
{
    RenderGraph graph(context());
    const BufferId sum = addSumPass(graph, "sum", graph.uploadBuffer("values", std::span(values)),
                                    std::uint32_t(values.size()), scale);
    graph.output(sum);
    graph.execute();
    return graph.read<float>(sum)[0];
}

} // namespace

TEST_CASE("sum: within 2e-7 of the magnitudes' sum, for any count and any series")
{
    // Around the places where quads, lanes and stages end; the largest has two stages and a tail.
    for (const std::uint32_t count :
         {1u, 2u, 3u, 4u, 5u, 31u, 32u, 33u, 16384u, 16385u, 1000003u}) {
        std::vector<float> spread = randomValues<float>(count, 60, -6.0f, 6.0f);
        for (float& v : spread)
            v = std::exp(v);
        std::vector<float> sorted = spread, ones(count, 1.0f), alternating(count);
        std::sort(sorted.begin(), sorted.end());
        for (std::uint32_t i = 0; i < count; ++i)
            alternating[i] = (i % 2 ? -1e4f : 1e4f) + 1e-3f * spread[i];
        for (const std::vector<float>& values : {spread, sorted, ones, alternating}) {
            CAPTURE(count);
            const std::vector<double> exact = convert<double>(values);
            double magnitudes = 0.0;
            for (const double v : exact)
                magnitudes += std::abs(v);
            const float got = deviceSum(values);
            // Rounding of the first stage's results and of the last one: two units of 6e-8.
            CHECK_LE(std::abs(got - reference::sum<double>(exact)), 2e-7 * magnitudes);
            const float again = deviceSum(values);
            CHECK_EQ(std::memcmp(&got, &again, sizeof got), 0);
        }
    }
    CHECK_EQ(deviceSum({1.0f, 2.0f, 4.5f}, 2.0f), 15.0f);
    CHECK(std::isnan(deviceSum({1.0f, NAN, 4.5f})));
    CHECK_EQ(context().validationMessages(), 0);
}

TEST_CASE("sum: nothing to add is refused")
{
    RenderGraph graph(context());
    CHECK_THROWS_AS((void)addSumPass(graph, "sum", graph.createBuffer("values", 16), 0), Error);
}
