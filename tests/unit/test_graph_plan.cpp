// The graph's plan is pure data: culling, order, versions, barriers and memory are tested without a
// device.
#include <doctest/doctest.h>

#include "engine/base/error.hpp"
#include "engine/graph/alias_planner.hpp"
#include "engine/graph/barrier_planner.hpp"
#include "engine/graph/dependency_graph.hpp"
#include "engine/graph/plan.hpp"
#include "engine/graph/render_graph.hpp"

using namespace strandlight;

namespace {

std::vector<std::string> names(const GraphPlan& plan)
{
    std::vector<std::string> list;
    for (const PlannedPass& pass : plan.passes)
        list.push_back(plan.description.passes[pass.pass].name);
    return list;
}

} // namespace

TEST_CASE("a pass that nobody reads is culled, with what only it needs")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId a = graph.createBuffer("a", 256), b = graph.createBuffer("b", 256),
             c = graph.createBuffer("c", 256);
    a = graph.addComputePass("make a").write(a);
    PassBuilder useless = graph.addComputePass("make b from a");
    useless.read(a);
    b = useless.write(b);
    PassBuilder used = graph.addComputePass("make c from a");
    used.read(a);
    c = used.write(c);
    graph.output(c);
    const GraphPlan& plan = graph.compile();
    CHECK(names(plan) == std::vector<std::string>{"make a", "make c from a"});
    CHECK(plan.culled == std::vector<std::uint32_t>{1});
    CHECK_FALSE(plan.resources[b.index].used);
}

TEST_CASE("an old version is refused by name of pass and resource")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    const BufferId first = graph.createBuffer("light", 16);
    const BufferId second = graph.addComputePass("writer").write(first);
    CHECK(second.version == 1);
    PassBuilder late = graph.addComputePass("late");
    CHECK_THROWS_WITH_AS(
        late.read(first),
        "pass 'late' uses version 0 of 'light', but pass 'writer' has written version 1",
        GraphError);
}

TEST_CASE("reading what nobody wrote, and outputs that nobody writes, are refused")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    const BufferId empty = graph.createBuffer("empty", 16);
    BufferId out = graph.createBuffer("out", 16);
    PassBuilder pass = graph.addComputePass("reader");
    pass.read(empty);
    out = pass.write(out);
    graph.output(out);
    CHECK_THROWS_WITH_AS(graph.compile(), "pass 'reader' reads 'empty', which no pass has written",
                         GraphError);

    RenderGraph second{RenderGraph::PlanOnly{}};
    second.output(second.createBuffer("nothing", 16));
    CHECK_THROWS_WITH_AS(second.compile(), "'nothing' is an output, but no pass writes it",
                         GraphError);
}

TEST_CASE("a pass uses a resource in one way")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    ImageId image = graph.createImage("image", {.width = 4, .height = 4});
    image = graph.addComputePass("make").write(image);
    PassBuilder pass = graph.addComputePass("both");
    pass.sample(image);
    CHECK_THROWS_AS((void)pass.write(image), GraphError);
}

TEST_CASE("dependencies that form a cycle are reported with the passes' names")
{
    GraphDescription description;
    description.passes = {{"egg", true, {}}, {"hen", true, {}}};
    const std::vector<std::vector<std::uint32_t>> needs = {{1}, {0}};
    CHECK_THROWS_WITH_AS(orderPasses(description, needs, {true, true}),
                         "passes wait for each other: 'egg', 'hen'", GraphError);
}

TEST_CASE("a write waits for every reader of the old contents")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId data = graph.createBuffer("data", 64), copy = graph.createBuffer("copy", 64);
    data = graph.addComputePass("make").write(data);
    PassBuilder reader = graph.addComputePass("reader");
    reader.read(data);
    copy = reader.write(copy);
    data = graph.addComputePass("overwrite").write(data);
    graph.output(data);
    graph.output(copy);
    const GraphPlan& plan = graph.compile();
    CHECK(names(plan) == std::vector<std::string>{"make", "reader", "overwrite"});
    REQUIRE(plan.passes[1].barriers.size() == 1);
    CHECK(plan.passes[1].barriers[0] ==
          PlannedBarrier{data.index, Usage::ShaderWrite, Usage::ShaderRead, false});
    REQUIRE(plan.passes[2].barriers.size() == 1);
    CHECK(plan.passes[2].barriers[0] ==
          PlannedBarrier{data.index, Usage::ShaderRead, Usage::ShaderWrite, false});
}

TEST_CASE("two reads of one kind share one barrier; a second kind gets its own")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId data = graph.createBuffer("data", 64);
    data = graph.addComputePass("make").write(data);
    for (const char* name : {"first", "second"}) {
        PassBuilder pass = graph.addComputePass(name);
        pass.read(data);
        pass.keep();
    }
    PassBuilder copy = graph.addTransferPass("copy");
    copy.read(data);
    copy.keep();
    const GraphPlan& plan = graph.compile();
    CHECK(plan.passes[1].barriers.size() == 1);
    CHECK(plan.passes[2].barriers.empty());
    REQUIRE(plan.passes[3].barriers.size() == 1);
    CHECK(plan.passes[3].barriers[0] ==
          PlannedBarrier{data.index, Usage::ShaderWrite, Usage::TransferRead, false});
}

TEST_CASE("images get a layout on first use and change it between kinds of reads")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    ImageId image = graph.createImage("image", {.width = 8, .height = 8});
    image = graph.addComputePass("make").write(image);
    PassBuilder sampler = graph.addComputePass("sample");
    sampler.sample(image);
    sampler.keep();
    PassBuilder loader = graph.addComputePass("load");
    loader.read(image);
    loader.keep();
    const GraphPlan& plan = graph.compile();
    CHECK(plan.passes[0].barriers[0] ==
          PlannedBarrier{image.index, Usage::None, Usage::ShaderWrite, true});
    CHECK(plan.passes[1].barriers[0] ==
          PlannedBarrier{image.index, Usage::ShaderWrite, Usage::Sample, false});
    CHECK(plan.passes[2].barriers[0] ==
          PlannedBarrier{image.index, Usage::Sample, Usage::ShaderRead, false});
}

TEST_CASE("the barrier table: a pair needs one exactly when a write or a layout change is in it")
{
    const Usage reads[] = {Usage::ShaderRead, Usage::Sample, Usage::DepthRead, Usage::TransferRead};
    const Usage writers[] = {Usage::ShaderWrite, Usage::ColorAttachment, Usage::DepthAttachment,
                             Usage::TransferWrite};
    for (const Usage before : writers)
        for (const Usage after : reads) {
            CHECK(needsBarrier(ResourceKind::Buffer, before, after));
            CHECK(needsBarrier(ResourceKind::Image, after, before));
        }
    for (const Usage before : reads)
        for (const Usage after : reads) {
            CHECK_FALSE(needsBarrier(ResourceKind::Buffer, before, after));
            CHECK(needsBarrier(ResourceKind::Image, before, after) == (before != after));
        }
}

TEST_CASE("a chain of transients shares two pieces of memory")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId last;
    for (int i = 0; i < 8; ++i) {
        const BufferId next = graph.createBuffer("t" + std::to_string(i), 1024);
        PassBuilder pass = graph.addComputePass("p" + std::to_string(i));
        if (last.valid())
            pass.read(last);
        last = pass.write(next);
    }
    PassBuilder end = graph.addComputePass("end");
    end.read(last);
    end.keep();
    const GraphPlan& plan = graph.compile();
    CHECK(plan.transientBytes == 8 * 1024);
    CHECK(plan.arenaBytes == 2 * 1024);
}

TEST_CASE("memory plan: what lives together never overlaps, over random lifetimes")
{
    std::uint32_t state = 7;
    const auto random = [&](std::uint32_t n) {
        return (state = state * 1664525u + 1013904223u) % 65521u % n;
    };
    for (int round = 0; round < 50; ++round) {
        std::vector<MemoryRequest> requests;
        for (int i = 0; i < 40; ++i) {
            const std::uint32_t first = random(30);
            requests.push_back({1 + random(5000), 1u << random(9), first, first + random(10)});
        }
        const MemoryPlan plan = planMemory(requests);
        for (std::size_t a = 0; a < requests.size(); ++a) {
            CHECK(plan.offsets[a] % requests[a].alignment == 0);
            CHECK(plan.offsets[a] + requests[a].bytes <= plan.bytes);
            for (std::size_t b = 0; b < a; ++b) {
                const bool together =
                    requests[a].first <= requests[b].last && requests[b].first <= requests[a].last;
                const bool overlap = plan.offsets[a] < plan.offsets[b] + requests[b].bytes &&
                                     plan.offsets[b] < plan.offsets[a] + requests[a].bytes;
                CHECK_FALSE((together && overlap));
            }
        }
    }
}

TEST_CASE("the plan prints as text and as Graphviz")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId data = graph.createBuffer("data", 64);
    data = graph.addComputePass("make").write(data);
    graph.output(data);
    CHECK(graph.text().find("make: data@0(shader write)") != std::string::npos);
    CHECK(graph.graphviz().find("digraph") == 0);
}

TEST_CASE("a write to an image waits once: reads in other layouts have waited for each other")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    ImageId image = graph.createImage("image", {.width = 4, .height = 4});
    image = graph.addComputePass("make").write(image);
    PassBuilder sampler = graph.addComputePass("sampler");
    sampler.sample(image);
    sampler.keep();
    PassBuilder reader = graph.addComputePass("reader");
    reader.read(image);
    reader.keep();
    image = graph.addComputePass("overwrite").write(image);
    graph.output(image);
    const GraphPlan& plan = graph.compile();
    REQUIRE(plan.passes.size() == 4);
    CHECK(plan.passes[3].barriers ==
          std::vector<PlannedBarrier>{{image.index, Usage::ShaderRead, Usage::ShaderWrite, false}});
}

TEST_CASE("a compiled graph is not changed")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId data = graph.createBuffer("data", 16);
    PassBuilder pass = graph.addTransferPass("fill");
    data = pass.write(data);
    graph.output(data);
    graph.compile();
    CHECK_THROWS_AS(graph.output(data), GraphError);
    CHECK_THROWS_AS(pass.read(data), GraphError);
    CHECK_THROWS_AS(pass.fill(data, 0), GraphError);
}

TEST_CASE("fill and copy work on what the pass declares")
{
    RenderGraph graph{RenderGraph::PlanOnly{}};
    BufferId from = graph.createBuffer("from", 16), to = graph.createBuffer("to", 16);
    PassBuilder pass = graph.addTransferPass("transfer");
    CHECK_THROWS_AS(pass.fill(from, 0), GraphError);
    from = pass.write(from);
    CHECK_NOTHROW(pass.fill(from, 0));
    PassBuilder second = graph.addTransferPass("copy");
    second.read(from);
    CHECK_THROWS_AS(second.copy(from, to, 16), GraphError);
    to = second.write(to);
    CHECK_NOTHROW(second.copy(from, to, 16));
}
