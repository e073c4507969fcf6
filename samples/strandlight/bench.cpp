// strandlight bench: the parent of the benchmarks.
#include "samples/strandlight/bench.hpp"

#include <algorithm>
#include <array>

#include "samples/strandlight/commands.hpp"

namespace strandlight::cli {

Command addBench(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("bench", "Check, then time, on this machine");
    app->require_subcommand(1);
    const std::array commands = {
        addBenchKernels(*app), addBenchHairFilter(*app), addBenchHair(*app), addBenchSkip(*app),
        addBenchGi(*app),      addBenchAll(*app),        addBenchPage(*app)};
    return {app, [commands] {
                const auto parsed = [](const Command& c) { return c.app->parsed(); };
                return std::find_if(commands.begin(), commands.end(), parsed)->run();
            }};
}

} // namespace strandlight::cli
