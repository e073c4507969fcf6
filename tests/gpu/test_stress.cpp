// The numerical stress matrix, once and small: `strandlight stress` runs the same groups for
// minutes.
#include <doctest/doctest.h>

#include "engine/base/progress.hpp"
#include "passes/stress/stress.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

void checkGroup(std::vector<StressRow> (*run)(Context&, const StressSettings&))
{
    const std::vector<StressRow> rows = run(test::context(), {});
    CHECK_FALSE(rows.empty());
    for (const StressRow& row : rows) {
        CAPTURE(row.name);
        CAPTURE(row.worst);
        CAPTURE(row.worstInput);
        CHECK_GT(row.cases, 0);
        CHECK_EQ(row.nonFinite, 0);
        CHECK_EQ(row.misses, 0);
        // Not everything is refused: a domain that is empty would hide a broken function.
        CHECK_LT(row.refused, row.cases);
    }
    CHECK_EQ(test::context().validationMessages(), 0);
}

} // namespace

TEST_CASE("stress: lobes")
{
    checkGroup(stressLobes);
}

TEST_CASE("stress: scattering")
{
    checkGroup(stressScattering);
}

TEST_CASE("stress: storage")
{
    checkGroup(stressStorage);
}

TEST_CASE("stress: elementwise")
{
    checkGroup(stressElementwise);
}

TEST_CASE("stress: mixtures")
{
    checkGroup(stressMixtures);
}

TEST_CASE("stress: convolutions")
{
    checkGroup(stressConvolutions);
}

TEST_CASE("stress: optimiser")
{
    checkGroup(stressOptimiser);
}

TEST_CASE("stress: traces")
{
    checkGroup(stressTraces);
}

TEST_CASE("stress: adversaries")
{
    Progress::setEnabled(false);
    checkGroup(stressAdversaries);
}
