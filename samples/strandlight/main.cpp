// The command: bakes, renders, measures. Exit codes: 0 done, 1 error (one line on stderr, nothing
// written), 130 interrupted.
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace {

using namespace strandlight;

constexpr int kFailed = 1;
constexpr int kInterrupted = 130; // 128 + SIGINT

constexpr char kExamples[] = "  strandlight bake builtin:room -o room.sgl\n"
                             "  strandlight render builtin:room --bake room.sgl -o room.png\n"
                             "  strandlight reference builtin:room -o truth.exr --spp 256\n"
                             "  strandlight compare room.png truth.png --heatmap difference.png\n"
                             "`strandlight COMMAND --help` shows the options of one command.";

int fail(const std::string& reason)
{
    std::string line = reason;
    for (char& c : line)
        c = c == '\n' || c == '\r' ? ' ' : c; // one line, whatever a file put into it
    std::fprintf(stderr, "error: %s\n", line.c_str());
    return kFailed;
}

int run(int argc, char** argv)
{
    CLI::App app("Strandlight: global illumination baked into spherical gaussian light fields",
                 "strandlight");
    app.set_version_flag("--version", std::string(cli::version()) + " " + cli::commit());
    app.require_subcommand(1);
    app.footer(std::string("Examples:\n") + kExamples);
    const cli::Command commands[] = {
        cli::addInfo(app),    cli::addBake(app),  cli::addRender(app), cli::addReference(app),
        cli::addCompare(app), cli::addFits(app),  cli::addReport(app), cli::addNnCheck(app),
        cli::addHair(app),    cli::addBench(app), cli::addStress(app)};
    // Of an unknown command CLI11 would only say that a subcommand is missing.
    const auto isNamed = [&](const CLI::App* known) { return known->get_name() == argv[1]; };
    if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(isNamed).empty())
        return fail("'" + std::string(argv[1]) +
                    "' is not a command; `strandlight --help` lists them");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0)
            return app.exit(error); // --help and --version
        return fail(error.what());
    }
    for (const cli::Command& command : commands)
        if (command.app->parsed())
            return command.run();
    return fail("no command");
}

} // namespace

int main(int argc, char** argv)
{
    installInterruptHandler();
    try {
        return run(argc, argv);
    } catch (const Interrupted&) {
        std::fprintf(stderr, "interrupted\n");
        return kInterrupted;
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
