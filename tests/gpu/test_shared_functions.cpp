// The shared shading functions mean the same on the device as in C++: 10,000 random inputs each.
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "engine/graph/render_graph.hpp"
#include "kernels/sg.gen.hpp"
#include "shaders/shared/function_echo.h"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

struct EchoPush
{
    std::uint32_t count;
};

} // namespace

TEST_CASE("shared functions: device and C++ agree")
{
    constexpr std::uint32_t kItems = 10000;
    RenderGraph graph(test::context());
    BufferId values =
        graph.createBuffer("echo", std::uint64_t(kItems) * gpu::kEchoValues * sizeof(float));
    PassBuilder pass = graph.addComputePass("echo");
    values = pass.write(values);
    pass.dispatch(kernels::function_echo, {kItems, 1, 1}, EchoPush{kItems}, {values});
    graph.output(values);
    graph.run();
    const std::vector<float> device = graph.read<float>(values);
    REQUIRE(device.size() == std::size_t(kItems) * gpu::kEchoValues);

    for (std::uint32_t v = 0; v < gpu::kEchoValues; ++v) {
        double worst = 0.0;
        std::uint32_t at = 0;
        for (std::uint32_t i = 0; i < kItems; ++i) {
            const float expected = gpu::echoFunctions(i).values[v];
            const float actual = device[std::size_t(i) * gpu::kEchoValues + v];
            // The device's exp is 4e-6 off and multiplies exponents up to 40; below 1e-6 a value is
            // nothing.
            const double error =
                std::abs(double(actual) - expected) / (1e-3 * std::abs(double(expected)) + 1e-5);
            if (!(error <= worst)) {
                worst = error;
                at = i;
            }
        }
        CAPTURE(v);
        CAPTURE(at);
        CAPTURE(device[std::size_t(at) * gpu::kEchoValues + v]);
        CAPTURE(gpu::echoFunctions(at).values[v]);
        CHECK(worst <= 1.0);
    }
}
