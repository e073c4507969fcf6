#include <doctest/doctest.h>

#include <cmath>

#include "compute_nn/conv2d.hpp"
#include "compute_nn/sg_mixture.hpp"
#include "engine/base/error.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/op_cases.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

// fp32 sums of up to a thousand products against double: measured below 1e-6, a wrong index gives
// 0.1 and more.
constexpr double kNormTolerance = 5e-6;
// Of the largest element.
constexpr double kElementTolerance = 2e-5;

std::vector<OpCase> allCases()
{
    std::vector<OpCase> cases;
    addConvCases(cases);
    addOtherCases(cases);
    return cases;
}

} // namespace

double strandlight::test::checkOutput(const Output& got, const ExpectedOutput& wanted)
{
    CAPTURE(got.name);
    REQUIRE_EQ(got.values.size(), wanted.values.size());
    const double error = relativeError(got.values, wanted.values);
    CHECK_LE(error, kNormTolerance);
    double largest = 0.0, worst = 0.0;
    for (std::size_t k = 0; k < wanted.values.size(); ++k) {
        largest = std::fmax(largest, std::abs(wanted.values[k]));
        worst = std::fmax(worst, std::abs(wanted.values[k] - got.values[k]));
    }
    CHECK_LE(worst, kElementTolerance * largest + 1e-30);
    return error;
}

namespace {

void checkOps(Context& on, const std::vector<OpCase>& cases)
{
    for (const OpCase& op : cases) {
        CAPTURE(op.name);
        const std::vector<Output> got = op.device(on);
        const std::vector<ExpectedOutput> wanted = op.twin();
        const std::vector<Output> again = op.device(on);
        REQUIRE_EQ(got.size(), wanted.size());
        for (std::size_t i = 0; i < got.size(); ++i) {
            CAPTURE(got[i].name);
            checkOutput(got[i], wanted[i]);
            CHECK(sameBits(got[i].values, again[i].values));
        }
    }
    CHECK_EQ(on.validationMessages(), 0);
}

} // namespace

TEST_CASE("every op: the device computes what the twin computes, and the same bits twice")
{
    checkOps(context(), allCases());
}

TEST_CASE("a GPU's forms of the convolutions compute the same on any device")
{
    if (!context().cpuForms()) // such a device takes these forms in every other test
        return;
    Context gpuForms = Context::headless({.validation = true, .gpuForms = true});
    std::vector<OpCase> cases;
    addGpuFormCases(cases);
    checkOps(gpuForms, cases);
}

TEST_CASE("kernels without subgroups give the same bits")
{
    if (context().subgroupSize() < 8) { // such a device takes these forms in every other test
        MESSAGE("fewer than eight lanes: no shuffles to compare with");
        return;
    }
    Context plain = Context::headless({.validation = true, .subgroups = false});
    REQUIRE_EQ(plain.subgroupSize(), 1);
    std::vector<OpCase> cases;
    addSubgroupCases(cases);
    for (const OpCase& op : cases) {
        CAPTURE(op.name);
        const std::vector<Output> with = op.device(context()), without = op.device(plain);
        for (std::size_t i = 0; i < with.size(); ++i) {
            CAPTURE(with[i].name);
            CHECK(sameBits(with[i].values, without[i].values));
        }
    }
    CHECK_EQ(plain.validationMessages(), 0);
}

TEST_CASE("a loop beyond the trip budget is refused on the host")
{
    const SgMixtureDesc desc{.images = 1, .lobes = 1, .directions = 32769};
    RenderGraph graph(context());
    const TensorDesc out{1, 3, 1, desc.directions};
    const TensorId raw = createTensor(graph, "raw", desc.raw());
    const TensorId dOut = createTensor(graph, "dOut", out);
    const BufferId along = graph.createBuffer("directions", desc.directions * 12);
    CHECK_THROWS_AS((void)sgMixtureBackward(graph, desc, raw, along, dOut,
                                            createTensor(graph, "dRaw", desc.raw())),
                    Error);
    CHECK_NOTHROW(checkTripBudget("any", 32768));
    CHECK_THROWS_AS(checkTripBudget("any", 32769), Error);
}

TEST_CASE("shapes that do not fit are refused by name")
{
    RenderGraph graph(context());
    const Conv2dDesc conv{.in = 4, .out = 2};
    const TensorId x = createTensor(graph, "x", {1, 4, 8, 8}),
                   y = createTensor(graph, "y", {1, 2, 8, 7});
    const LayerWeights weights{graph.createBuffer("w", 1024), 0, 0, false};
    try {
        (void)conv2dForward(graph, "layer seven", conv, x, weights, y);
        FAIL("accepted");
    } catch (const Error& error) {
        const std::string text = error.what();
        CHECK_NE(text.find("layer seven"), std::string::npos);
        CHECK_NE(text.find("[1,2,8,7]"), std::string::npos);
    }
}
