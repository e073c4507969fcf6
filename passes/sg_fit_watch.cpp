#include "passes/sg_fit_watch.hpp"

#include "passes/sg_fit_irradiance.hpp"

namespace strandlight {

void FitWatch::start()
{
    start_ = Clock::now();
    next_ = looking_ = 0.0;
}

void FitWatch::update(const FitProblem& problem, const std::function<SgField()>& make)
{
    const auto secondsSinceStart = [&] {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    };
    if (secondsSinceStart() < next_)
        return;
    const Clock::time_point paused = Clock::now();
    SgField lobes = make();
    matchIrradiance(problem, lobes);
    const double seconds = secondsSinceStart();
    look_(lobes, seconds);
    const Clock::duration took = Clock::now() - paused;
    looking_ += std::chrono::duration<double>(took).count();
    start_ += took;
    next_ = 1.25 * secondsSinceStart();
}

} // namespace strandlight
