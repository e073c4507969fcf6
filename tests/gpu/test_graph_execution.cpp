// The executor against what a graph promises, with validation on.
#include <doctest/doctest.h>

#include <numeric>

#include "engine/base/error.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/render_graph.hpp"
#include "kernels.gen.hpp"
#include "shaders/shared/sample_types.h"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

BufferId addSquarePass(RenderGraph& graph, BufferId values, std::uint32_t count,
                       std::uint32_t groupSize)
{
    PassBuilder pass = graph.addComputePass("square");
    values = pass.write(values);
    pass.dispatch(kernels::square_values, {count, 1, 1}, gpu::SquarePush{count}, {values},
                  {groupSize});
    return values;
}

} // namespace

TEST_CASE("buffers: upload, two dependent passes, read back, for several group sizes")
{
    std::vector<float> input(1000);
    std::iota(input.begin(), input.end(), 0.0f);
    for (const std::uint32_t groupSize : {1u, 7u, 64u}) {
        RenderGraph graph(test::context());
        BufferId values = graph.uploadBuffer("values", std::span<const float>(input));
        values = addSquarePass(graph, values, 1000, groupSize);
        values = addSquarePass(graph, values, 1000, groupSize);
        graph.output(values);
        graph.run();
        const std::vector<float> out = graph.read<float>(values);
        REQUIRE(out.size() == 1000);
        CHECK(out[3] == 81.0f);
        CHECK(out[10] == 10000.0f);
        CHECK(out[999] == doctest::Approx(999.0 * 999.0 * 999.0 * 999.0));
    }
    CHECK(test::context().validationMessages() == 0);
}

TEST_CASE("images: compute writes, raster samples, the copy is read back")
{
    RenderGraph graph(test::context());
    ImageId gradient = graph.createImage("gradient", {.width = 37, .height = 21});
    PassBuilder make = graph.addComputePass("gradient");
    gradient = make.write(gradient);
    make.dispatch(kernels::gradient, graph.extent(gradient), gpu::GradientPush{37, 21, 2.0f},
                  {gradient});
    ImageId copy =
        graph.createImage("copy", {.width = 37, .height = 21, .format = Format::RGBA16F});
    PassBuilder draw = graph.addRasterPass("copy");
    draw.sample(gradient);
    copy = draw.color(copy);
    draw.draw(
        {.vertex = &kernels::full_screen_vert, .fragment = &kernels::sample_image_frag, .depthTest = false},
        3, 1, NoPush{}, {{gradient, Filter::Nearest}});
    graph.output(copy);
    graph.setTimings(true);
    graph.run();
    const CpuImage out = graph.read(copy);
    CHECK(out.at(36, 20).x == doctest::Approx(2.0 * 36.5 / 37.0).epsilon(1e-3));
    CHECK(out.at(0, 10).y == doctest::Approx(1.0).epsilon(1e-3));
    CHECK(graph.timings().size() == 2);
    CHECK(test::context().validationMessages() == 0);
}

TEST_CASE("aliased transients do not disturb each other, and a graph may run twice")
{
    RenderGraph graph(test::context());
    Buffer result(test::context(), 64, "result");
    BufferId out = graph.importBuffer(result);
    for (std::uint32_t i = 0; i < 4; ++i) {
        BufferId data = graph.createBuffer("t" + std::to_string(i), 64);
        PassBuilder fill = graph.addTransferPass("fill");
        data = fill.write(data);
        fill.fill(data, 0x40000000u); // 2.0f
        data = addSquarePass(graph, data, 16, 8);
        PassBuilder copy = graph.addTransferPass("copy");
        copy.read(data);
        out = copy.write(out);
        copy.copy(data, out, 64);
    }
    graph.run();
    graph.run();
    CHECK(result.downloadAs<float>() == std::vector<float>(16, 4.0f));
    CHECK(graph.compile().arenaBytes < graph.compile().transientBytes);
    CHECK(test::context().validationMessages() == 0);
}

TEST_CASE("mistakes at a binding are named: kind, direction, push size, missing declaration")
{
    const auto run = [](auto build) {
        RenderGraph graph(test::context());
        build(graph);
        graph.run();
    };
    CHECK_THROWS_WITH_AS(
        run([](RenderGraph& graph) {
            const float one = 1.0f;
            BufferId values = graph.uploadBuffer("values", std::span<const float>(&one, 1));
            PassBuilder pass = graph.addComputePass("wrong");
            pass.read(values);
            pass.keep();
            pass.dispatch(kernels::square_values, {1, 1, 1}, gpu::SquarePush{1}, {values}, {1});
        }),
        "pass 'wrong', kernel square_values, binding 0: the shader may write 'values', the pass "
        "only "
        "reads it (say `readonly` in the shader, or write() in the pass)",
        GraphError);
    CHECK_THROWS_AS(run([](RenderGraph& graph) {
                        BufferId values = graph.createBuffer("values", 16);
                        PassBuilder pass = graph.addComputePass("wrong");
                        values = pass.write(values);
                        pass.keep();
                        pass.dispatch(kernels::square_values, {1, 1, 1}, NoPush{}, {values}, {1});
                    }),
                    GraphError);
    CHECK(test::context().validationMessages() == 0);
}

TEST_CASE("the memory budget is kept: too much is refused by name, and what fits still works")
{
    ContextSettings settings;
    settings.memoryBudget = std::uint64_t(64) << 20;
    Context small = Context::headless(settings);
    Buffer fits(small, 1 << 20, "fits");
    CHECK_THROWS_AS(Buffer(small, std::uint64_t(128) << 20, "too big"), VulkanError);
    CHECK(small.bytesAllocated() >= (1u << 20));
    CHECK(small.peakBytesAllocated() < settings.memoryBudget);
}

TEST_CASE("an unknown device is refused with the list of what there is")
{
    ContextSettings settings;
    settings.device = "no such device";
    CHECK_THROWS_AS(Context::headless(settings), VulkanError);
}

TEST_CASE("the validation layer is awake: a seeded fault is heard")
{
    ContextSettings settings;
    settings.validation = true;
    Context device = Context::headless(settings);
    RenderGraph graph(device);
    BufferId values = graph.createBuffer("values", 4);
    PassBuilder pass = graph.addComputePass("oversized group");
    values = pass.write(values);
    pass.keep();
    // 4096 invocations per group: past maxComputeWorkGroupInvocations of every device in use.
    pass.dispatch(kernels::square_values, {4096, 1, 1}, gpu::SquarePush{1}, {values}, {65536});
    CHECK_THROWS(graph.run());
    CHECK(device.validationMessages() > 0);
}
