// The executor against what a graph promises, with validation on.
#include <doctest/doctest.h>

#include <numeric>

#include "engine/base/error.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/render_graph.hpp"
#include "kernels/sample.gen.hpp"
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
    draw.draw({.vertex = &kernels::full_screen_vert,
               .fragment = &kernels::sample_image_frag,
               .depthTest = false},
              3, 1, NoPush{}, {{gradient, Filter::Nearest}});
    graph.output(copy);
    graph.setTimings(Timings::Passes);
    graph.run();
    const CpuImage out = graph.read(copy);
    CHECK(out.at(36, 20).x == doctest::Approx(2.0 * 36.5 / 37.0).epsilon(1e-3));
    CHECK(out.at(0, 10).y == doctest::Approx(1.0).epsilon(1e-3));
    CHECK(graph.timings().size() == 2);
    graph.setTimings(Timings::Whole);
    graph.execute();
    CHECK(graph.timings().size() == 1);
    CHECK(graph.timings().front().milliseconds > 0.0);
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

TEST_CASE("memory of large resources is given back: a budget for two holds any number in turn")
{
    ContextSettings settings;
    settings.memoryBudget = std::uint64_t(64) << 20;
    Context small = Context::headless(settings);
    for (int i = 0; i < 4; ++i)
        CHECK_NOTHROW(Buffer(small, std::uint64_t(32) << 20, "large"));
    CHECK(small.bytesAllocated() == 0);
}

TEST_CASE("an unknown device is refused with the list of what there is")
{
    ContextSettings settings;
    settings.device = "no such device";
    CHECK_THROWS_AS(Context::headless(settings), VulkanError);
    // A number is an index, although it may stand in a device's name ("LLVM 15").
    settings.device = std::to_string(Context::devices().size());
    CHECK_THROWS_AS(Context::headless(settings), VulkanError);
}

TEST_CASE("a graph that fails while it is recorded leaves its imports usable")
{
    Image image(test::context(), {.width = 4, .height = 4}, "kept");
    CpuImage pixels(4, 4);
    pixels.at(2, 3) = glm::vec4(5.0f);
    image.upload(pixels);
    {
        RenderGraph graph(test::context());
        ImageId id = graph.importImage(image);
        PassBuilder good = graph.addComputePass("good");
        id = good.write(id);
        PassBuilder bad = graph.addComputePass("bad");
        bad.sample(id);
        bad.keep();
        bad.dispatch(kernels::gradient, {4, 4, 1}, gpu::GradientPush{4, 4, 1.0f}, {id});
        CHECK_THROWS_AS(graph.run(), GraphError);
    }
    CHECK(image.download().at(2, 3) == glm::vec4(5.0f));
    CHECK(test::context().validationMessages() == 0);
}

TEST_CASE("a shader that cannot be made is refused each time, not only the first")
{
    const std::uint32_t words[] = {0x07230203u, 0x00010500u, 0u, 1u, 0u, 0x00000011u};
    const KernelBlob broken{"broken", words, std::size(words)};
    for (int i = 0; i < 2; ++i) {
        RenderGraph graph(test::context());
        PassBuilder pass = graph.addComputePass("broken");
        pass.keep();
        pass.dispatch(broken, {1, 1, 1}, NoPush{}, {});
        CHECK_THROWS_WITH_AS(graph.run(), "shader broken: broken SPIR-V", Error);
    }
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
