// strandlight bench all, bench report: every benchmark into one folder, and the page about it.
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "samples/strandlight/bench.hpp"
#include "samples/strandlight/bench_page.hpp"

namespace strandlight::cli {

namespace fs = std::filesystem;

namespace {

struct Options
{
    bool quick = false;
    std::string folder;
    std::string device;
};

struct Part
{
    const char* name;
    Command (*add)(CLI::App&);
    bool pictures; // takes a folder for them
};

// In the order of the page.
constexpr std::array kParts = {Part{"gi", addBenchGi, true}, Part{"hair", addBenchHair, true},
                               Part{"skip", addBenchSkip, false},
                               Part{"kernels", addBenchKernels, false}};

// As if it had been typed, so that a benchmark has one way in.
void runPart(const Part& part, const Options& o)
{
    std::printf("== bench %s\n", part.name);
    const std::string stem = (fs::path(o.folder) / part.name).string();
    // CLI11 takes the last argument first.
    std::vector<std::string> arguments{stem + ".csv", "--csv", stem + ".json", "--json"};
    if (o.quick)
        arguments.push_back("--quick");
    if (!o.device.empty())
        arguments.insert(arguments.end(), {o.device, "--device"});
    if (part.pictures)
        arguments.insert(arguments.end(), {o.folder, "--out"});
    arguments.push_back(part.name);
    CLI::App app;
    const Command command = part.add(app);
    app.parse(arguments);
    command.run();
    std::fflush(stdout);
}

void writePage(const Options& o)
{
    std::vector<Json> benches;
    for (const Part& part : kParts) {
        const fs::path path = fs::path(o.folder) / (std::string(part.name) + ".json");
        if (!fs::exists(path))
            continue;
        const std::vector<std::uint8_t> bytes = readFile(path, 64u << 20);
        Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
        if (!json.is_object() || !json.contains("rows") || !json["rows"].is_array())
            throw FileError(path.string(), "", "was not written by --json of a benchmark");
        benches.push_back(std::move(json));
    }
    if (benches.empty())
        throw FileError(o.folder, "", "holds no kernels.json, gi.json, hair.json or skip.json");
    const fs::path page = fs::path(o.folder) / "report.html";
    writeFileAtomically(page, benchPageHtml(benches, o.folder));
    std::printf("wrote     %s\n", page.c_str());
}

void addFolder(CLI::App& app, Options& o)
{
    app.add_option("--out", o.folder, "Folder of the results")->required()->type_name("FOLDER");
}

} // namespace

Command addBenchAll(CLI::App& bench)
{
    CLI::App* app = bench.add_subcommand("all", "Every benchmark, and a page about them");
    const auto o = std::make_shared<Options>();
    addFolder(*app, *o);
    app->add_flag("--quick", o->quick, "Small cases, few runs: within ten minutes on two cores");
    app->add_option("--device", o->device, "Index or part of the name")->type_name("DEVICE");
    addExamples(*app, "  strandlight bench all --quick --out out/bench");
    return {app, [o] {
                fs::create_directories(o->folder);
                for (const Part& part : kParts)
                    runPart(part, *o);
                writePage(*o);
                return 0;
            }};
}

Command addBenchPage(CLI::App& bench)
{
    CLI::App* app =
        bench.add_subcommand("report", "Draw report.html again from a folder's results");
    const auto o = std::make_shared<Options>();
    addFolder(*app, *o);
    return {app, [o] {
                writePage(*o);
                return 0;
            }};
}

} // namespace strandlight::cli
