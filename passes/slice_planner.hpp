// How much work one dispatch gets: aims at a time that neither a watchdog nor a waiting user minds.
#pragma once

#include <algorithm>
#include <cstdint>

namespace strandlight {

class SlicePlanner
{
public:
    // `fixed` > 0 switches the adaptation off.
    explicit SlicePlanner(std::uint32_t fixed, std::uint32_t start = 1024)
        : fixed_(fixed), items_(fixed > 0 ? fixed : start)
    {
    }

    std::uint32_t items() const { return items_; }

    // The last slice had `items` items and took this long. Whole groups of 32, at most doubled.
    void finished(std::uint32_t items, double milliseconds)
    {
        // The first dispatch also compiles the kernel.
        if (first_) {
            first_ = false;
            return;
        }
        slowestMs_ = std::max(slowestMs_, milliseconds);
        if (fixed_ > 0 || items < items_)
            return;
        const double factor = std::clamp(kTargetMs / std::max(milliseconds, 0.1), 0.25, 2.0);
        const double next = std::clamp(double(items_) * factor, 32.0, double(1u << 22u));
        items_ = std::uint32_t(next) / 32u * 32u;
    }
    double slowestMs() const { return slowestMs_; }

private:
    // Half of the 100 ms that no dispatch may exceed.
    static constexpr double kTargetMs = 50.0;
    std::uint32_t fixed_;
    std::uint32_t items_;
    double slowestMs_ = 0.0;
    bool first_ = true;
};

} // namespace strandlight
