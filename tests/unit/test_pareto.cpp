// The front of a hand-made set.
#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "passes/pareto.hpp"

using strandlight::paretoFront;

TEST_CASE("pareto front: dominated, equal and unusable choices")
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    //                                cheap  good  equal  same cost, worse  dominated  unusable
    const std::vector<double> cost = {1.0, 4.0, 4.0, 4.0, 5.0, kNan, 0.0, 2.0};
    const std::vector<double> error = {9.0, 1.0, 1.0, 2.0, 3.0, 0.0, kInfinity, 9.0};
    const std::vector<bool> expected = {true, true, true, false, false, false, false, false};
    CHECK(paretoFront(cost, error) == expected);
    CHECK(paretoFront({}, {}).empty());
}
