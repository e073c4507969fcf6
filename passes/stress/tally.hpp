// Counts what happens to one function under stress and remembers its worst input.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "passes/stress/stress.hpp"

namespace strandlight {

class Tally
{
public:
    using Describe = std::function<std::string()>; // the input, as text; called for new worst ones

    Tally(std::string name, double tolerance, std::string unit)
    {
        row_.name = std::move(name);
        row_.tolerance = tolerance;
        row_.unit = std::move(unit);
    }

    // `value` should be `expected` within tolerance x `scale`.
    void compare(double value, double expected, double scale, const Describe& describe)
    {
        ++row_.cases;
        if (!std::isfinite(value)) {
            ++row_.nonFinite;
            miss(describe);
            return;
        }
        const double share = std::abs(value - expected) / (row_.tolerance * scale);
        if (!(share <= 1.0))
            miss(describe);
        if (share > row_.worst) {
            row_.worst = share;
            if (row_.misses == 0 || share > 1.0)
                row_.worstInput = describe();
        }
    }

    // A value that must be finite and in [low, high].
    void bound(double value, double low, double high, const Describe& describe)
    {
        ++row_.cases;
        row_.nonFinite += std::isfinite(value) ? 0 : 1;
        if (!(value >= low && value <= high))
            miss(describe);
    }

    // An input outside the domain: may give NaN, which shows, or a value in bounds, but no
    // plausible nonsense.
    void refuse(double value, double low, double high, const Describe& describe)
    {
        ++row_.cases;
        ++row_.refused;
        if (std::isfinite(value) && !(value >= low && value <= high))
            miss(describe);
    }
    void refuse()
    {
        ++row_.cases;
        ++row_.refused;
    }
    // A property that holds or does not.
    void require(bool holds, const Describe& describe)
    {
        ++row_.cases;
        if (!holds)
            miss(describe);
    }
    void clamped(std::uint64_t count) { row_.clamped += count; }

    const StressRow& row() const { return row_; }

private:
    void miss(const Describe& describe)
    {
        if (row_.misses++ == 0)
            row_.worstInput = describe();
    }

    StressRow row_;
};

} // namespace strandlight
