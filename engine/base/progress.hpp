// Progress of long work: a bar with time left on a terminal, plain lines otherwise; and the user's
// wish to stop.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace strandlight {

// Called by main: SIGINT and SIGTERM set a flag that long work reads between slices.
void installInterruptHandler();
bool interruptRequested();
void throwIfInterrupted(); // throws Interrupted

class Progress
{
public:
    Progress(std::string title, std::uint64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // `done` of `total` units are finished. Cheap: draws at most ten times a second.
    void update(std::uint64_t done);

    static void setEnabled(bool enabled); // off in tests

private:
    void draw(bool last);

    std::string title_;
    std::uint64_t total_;
    std::uint64_t done_ = 0;
    std::chrono::steady_clock::time_point start_;
    std::chrono::steady_clock::time_point lastDraw_;
};

} // namespace strandlight
