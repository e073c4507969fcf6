#include "engine/base/progress.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <unistd.h>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> progressEnabled{true};

void onSignal(int)
{
    interrupted = true;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

void installInterruptHandler()
{
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
}

bool interruptRequested()
{
    return interrupted;
}

void throwIfInterrupted()
{
    if (interrupted)
        throw Interrupted();
}

void Progress::setEnabled(bool enabled)
{
    progressEnabled = enabled;
}

Progress::Progress(std::string title, std::uint64_t total)
    : title_(std::move(title)), total_(std::max<std::uint64_t>(total, 1)),
      start_(std::chrono::steady_clock::now()), lastDraw_(start_)
{
}

Progress::~Progress()
{
    draw(true);
}

void Progress::update(std::uint64_t done)
{
    done_ = done;
    const double interval = isatty(STDERR_FILENO) ? 0.1 : 10.0;
    if (secondsSince(lastDraw_) >= interval)
        draw(false);
}

void Progress::draw(bool last)
{
    if (!progressEnabled)
        return;
    lastDraw_ = std::chrono::steady_clock::now();
    const double elapsed = secondsSince(start_);
    const double fraction = std::min(1.0, double(done_) / double(total_));
    const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
    if (!isatty(STDERR_FILENO)) {
        std::fprintf(stderr, "%s %3.0f %%, %.1f s%s\n", title_.c_str(), fraction * 100.0, elapsed,
                     last ? "" : (", " + std::to_string(int(left)) + " s left").c_str());
        return;
    }
    const int filled = int(fraction * 30.0);
    std::fprintf(stderr, "\r%-18s [%.*s%.*s] %3.0f %%  %.1f s", title_.c_str(), filled,
                 "##############################", 30 - filled, "..............................",
                 fraction * 100.0, elapsed);
    std::fprintf(stderr, last ? "              \n" : ", %.0f s left   ", left);
}

} // namespace strandlight
