// Small normal equations, gram x = right, on the CPU. gram [n, n] row-major, right [n]; returns x
// [n].
#pragma once

#include <vector>

namespace strandlight {

// `gram` symmetric positive definite.
std::vector<double> solveDefinite(std::vector<double> gram, std::vector<double> right);

// min over x >= 0 of x^T gram x - 2 right^T x by cyclic coordinate descent. Columns that are zero
// in `gram` get 0.
std::vector<double> solveNonNegative(const std::vector<double>& gram,
                                     const std::vector<double>& right);

} // namespace strandlight
