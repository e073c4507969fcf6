// strandlight nn check: the network operations of this device against vectors from elsewhere.
#include <cstdio>
#include <memory>

#include "compute_nn/check.hpp"
#include "engine/base/progress.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    DeviceOptions device;
    std::vector<std::string> files;
    std::string json;
};

void print(const CheckReport& report)
{
    std::printf("%s  %s (%s)\n", report.pass() ? "ok    " : "FAILED", report.file.c_str(),
                report.op.c_str());
    for (const CheckRow& row : report.rows)
        std::printf("        %-24s %.2e  (at most %.0e)%s\n", row.name.c_str(), row.error,
                    row.tolerance, row.pass ? "" : "  FAILED");
}

Json describe(const CheckReport& report)
{
    Json rows = Json::array();
    for (const CheckRow& row : report.rows)
        rows.push_back({{"name", row.name},
                        {"error", row.error},
                        {"tolerance", row.tolerance},
                        {"pass", row.pass}});
    return {{"file", report.file}, {"op", report.op}, {"pass", report.pass()}, {"rows", rows}};
}

int run(const Options& o)
{
    requireOutput(o.json, {".json"});
    Context context = openDevice(o.device);
    Json json = describeRun("nn check", &context);
    json["files"] = Json::array();
    std::size_t passed = 0;
    for (const std::string& file : o.files) {
        throwIfInterrupted();
        const CheckReport report = checkFile(context, file);
        print(report);
        json["files"].push_back(describe(report));
        passed += report.pass() ? 1 : 0;
    }
    std::printf("%zu of %zu files pass on %s\n", passed, o.files.size(),
                context.device().name.c_str());
    writeJson(o.json, json);
    return passed == o.files.size() ? 0 : 1;
}

} // namespace

Command addNnCheck(CLI::App& parent)
{
    CLI::App* nn = parent.add_subcommand("nn", "Neural network operations");
    nn->require_subcommand(1);
    CLI::App* app = nn->add_subcommand(
        "check", "Run the op that each file's metadata names and compare results, gradients, loss");
    const auto o = std::make_shared<Options>();
    app->add_option("FILES", o->files, ".safetensors")->required()->type_name("");
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app, "  strandlight nn check vectors/*.safetensors\n"
                      "Exit code 1 when any error is past its tolerance.");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
