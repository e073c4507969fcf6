// strandlight report: pictures, errors and settings as one HTML file.
#include <cstdio>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/flip.hpp"
#include "engine/base/image_io.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/report_page.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    std::string picture;
    std::string reference;
    std::vector<std::string> results;
    std::string output;
    std::string title;
    float exposure = 0.0f;
    std::string json;
};

Json readJson(const std::string& path)
{
    const std::vector<std::uint8_t> bytes = readFile(path, 64u << 20);
    Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (json.is_discarded())
        throw FileError(path, "", "is not valid JSON");
    if (!json.is_object() || !json.contains("command") || !json["command"].is_string())
        throw FileError(path, "", "was not written by --json of this command: no \"command\"");
    return json;
}

void readResults(const Options& o, ReportPage& page)
{
    for (const std::string& path : o.results) {
        Json json = readJson(path);
        const std::string command = json["command"];
        if (command == "bake")
            page.bake = std::move(json);
        else if (command == "render")
            page.render = std::move(json);
        else if (command == "reference")
            page.truth = std::move(json);
        else
            throw FileError(path, "\"command\"",
                            "'" + command + "' is none of bake, render, reference");
    }
}

int run(const Options& o)
{
    requireOutput(o.output, {".html"});
    requireOutput(o.json, {".json"});
    ReportPage page;
    readResults(o, page);
    page.picture = loadImage(o.picture);
    page.reference = loadImage(o.reference);
    page.exposure = o.exposure;
    CompareSettings settings;
    settings.exposureStops = o.exposure;
    page.comparison = compareImages(page.picture, page.reference, settings);
    page.flip = computeFlip(displayImage(page.picture, o.exposure),
                            displayImage(page.reference, o.exposure));
    page.title = o.title.empty() ? o.picture : o.title;
    writeFileAtomically(o.output, reportHtml(page));
    std::printf("wrote     %s\n", o.output.c_str());

    Json json = describeRun("report", nullptr);
    json["result"] = {{"file", o.output}, {"flip", page.comparison.flip}};
    writeJson(o.json, json);
    return 0;
}

} // namespace

Command addReport(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("report", "Write pictures, errors and settings as HTML");
    const auto o = std::make_shared<Options>();
    app->add_option("--render", o->picture, "The picture from the bake, .exr or .png")
        ->required()
        ->type_name("FILE");
    app->add_option("--reference", o->reference, "Its truth")->required()->type_name("FILE");
    app->add_option("--results", o->results, "What --json of bake, render and reference wrote")
        ->type_name("FILE");
    app->add_option("-o,--output", o->output, "The page, .html")->required()->type_name("FILE");
    app->add_option("--title", o->title, "Of the page; default: the picture's name")
        ->type_name("TEXT");
    app->add_option("--exposure", o->exposure, "Stops, of the pictures and of FLIP, SSIM, PSNR")
        ->type_name("STOPS")
        ->capture_default_str()
        ->check(CLI::Range(-40.0, 40.0));
    addJsonOption(*app, o->json);
    addExamples(*app, "  strandlight report --render room.exr --reference truth.exr "
                      "--results bake.json render.json truth.json -o room.html");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
