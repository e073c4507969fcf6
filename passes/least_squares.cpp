#include "passes/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace strandlight {

// Gaussian elimination; a definite matrix needs no pivoting.
std::vector<double> solveDefinite(std::vector<double> a, std::vector<double> x)
{
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t row = i + 1; row < n; ++row) {
            const double factor = a[row * n + i] / a[i * n + i];
            for (std::size_t column = i; column < n; ++column)
                a[row * n + column] -= factor * a[i * n + column];
            x[row] -= factor * x[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t column = i + 1; column < n; ++column)
            x[i] -= a[i * n + column] * x[column];
        x[i] /= a[i * n + i];
    }
    return x;
}

std::vector<double> solveNonNegative(const std::vector<double>& gram,
                                     const std::vector<double>& right)
{
    const std::size_t n = right.size();
    std::vector<double> x(n, 0.0);
    for (int sweep = 0; sweep < 1000; ++sweep) {
        double largestChange = 0.0, largest = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!(gram[i * n + i] > 0.0))
                continue;
            double rest = right[i];
            for (std::size_t j = 0; j < n; ++j)
                if (j != i)
                    rest -= gram[i * n + j] * x[j];
            const double next = std::max(0.0, rest / gram[i * n + i]);
            largestChange = std::max(largestChange, std::abs(next - x[i]));
            largest = std::max(largest, next);
            x[i] = next;
        }
        if (largestChange <= 1.0e-7 * largest)
            break;
    }
    return x;
}

} // namespace strandlight
