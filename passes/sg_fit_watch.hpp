// Looks at a fit while it works, for curves of error over time.
#pragma once

#include <chrono>
#include <functional>

#include "passes/sg_field.hpp"
#include "passes/sg_fit_cells.hpp"

namespace strandlight {

class FitWatch
{
public:
    // Lobes so far, with irradiance matched, and the seconds after which the fit would have
    // returned them had it stopped there. What looking costs is not counted.
    using Look = std::function<void(const SgField& lobes, double seconds)>;

    explicit FitWatch(Look look) : look_(std::move(look)) {}

    void start(); // the fit begins
    double secondsLooking() const { return looking_; }
    // Calls the look with the lobes of `make` when the time since the last look has grown by a
    // quarter.
    void update(const FitProblem& problem, const std::function<SgField()>& make);

private:
    using Clock = std::chrono::steady_clock;

    Look look_;
    Clock::time_point start_; // moved forward by what looking costs
    double next_ = 0.0;
    double looking_ = 0.0;
};

} // namespace strandlight
