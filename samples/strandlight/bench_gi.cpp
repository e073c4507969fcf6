// strandlight bench gi: run time and bytes against error, for global illumination.
#include "samples/strandlight/bench_gi.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory>

#include "engine/base/error.hpp"
#include "passes/sg_textures.hpp"
#include "samples/strandlight/savings_text.hpp"

namespace strandlight::cli {

namespace fs = std::filesystem;

namespace {

// Pictures of the base choice for the report; their names are relative to the folder.
Json savePictures(const fs::path& folder, const std::string& scene, const GiStudy& study)
{
    std::string stem = "gi_" + fs::path(scene).filename().string();
    for (char& c : stem)
        c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    const GiRow& base = study.rows.front();
    return savePictureSet(folder, stem, scene,
                          "Baked in " + fixed(base.bakeSeconds, 1) + " s with an atlas of " +
                              std::to_string(base.choice.atlas) + "; FLIP " + fixed(base.flip, 3),
                          study.picture, study.truth);
}

Json passesOf(const std::string& scene, const FrameResult& frame, const BakeSavings& savings)
{
    Json rows = Json::array();
    for (const PassTiming& timing : frame.timings)
        rows.push_back({{"name", timing.pass}, {"milliseconds", timing.milliseconds}});
    return {{"title", "Passes of a frame, " + scene},
            {"rows", rows},
            {"skipped", frame.skipped},
            {"savings", describeSavings(savings, kDeviceLobeBytes)},
            {"target_bytes", frame.targetBytes},
            {"arena_bytes", frame.arenaBytes}};
}

// What the scene did not need, as `render --stats` tells it.
void printSkipped(const std::string& scene, const GiStudy& study)
{
    std::printf("a frame of %s, %zu passes\n", scene.c_str(), study.frame.passes.size());
    for (const std::string& pass : study.frame.skipped)
        std::printf("culled    %s\n", pass.c_str());
    printSavings(study.savings, kDeviceLobeBytes);
    printSharing(study.frame);
    std::printf("\n");
}

void printStudy(const Json& rows, const char* study, std::initializer_list<const char*> columns)
{
    Json some = Json::array();
    for (const Json& row : rows) {
        if (row["study"] != study)
            continue;
        Json part;
        for (const char* column : columns)
            part[column] = row.value(column, Json(nullptr));
        some.push_back(std::move(part));
    }
    std::printf("%s\n%s\n", study, rowsText(some).c_str());
}

void print(const Json& rows, const Json& facts)
{
    printStudy(rows, "gi",
               {"name", "texels", "bytes_per_texel", "bake_s", "fit_s", "shading_ms", "rmse_texel",
                "rmse_between", "flip", "relmse", "ssim", "on_bytes_front", "on_bake_front"});
    printStudy(rows, "fit over time", {"name", "fit_s", "rmse_between"});
    printStudy(rows, "specular", {"name", "error"});
    printStudy(rows, "diffuse", {"name", "error"});
    for (const Json& fact : facts)
        std::printf("%s: %s\n", fact.value("label", "").c_str(), fact.value("value", "").c_str());
}

} // namespace

std::vector<GiBenchScene> giBenchScenes(const GiBenchOptions& options)
{
    std::vector<GiBenchScene> scenes;
    for (const std::string& scene : options.scenes)
        scenes.push_back({fs::path(scene).filename().string(), {scene, options.environment}, ""});
    if (!scenes.empty())
        return scenes;
    scenes.push_back({"builtin:room", {"builtin:room", ""}, ""});
    const auto add = [&](const char* name, const char* file, const char* environment,
                         const char* camera) {
        const fs::path data = options.data;
        const std::string env = *environment ? (data / "env" / environment).string() : "";
        if (!options.data.empty() && fs::exists(data / "scenes" / file))
            scenes.push_back({name, {(data / "scenes" / file).string(), env}, camera});
    };
    add("cornell_lambert", "cornell_lambert.gltf", "", "");
    if (options.common.quick)
        return scenes;
    add("cornellBox", "cornellBox.gltf", "", "");
    add("room", "room.glb", "std_env.hdr", "-4,1.6,-3,3,1.5,3,60");
    add("living_room", "living_room.glb", "std_env.hdr", "0,1.5,1.5,-4,0,-2,60");
    return scenes;
}

void benchGi(const GiBenchOptions& options)
{
    Context context = openDevice(options.common.device);
    BenchReport report("bench gi", options.common, context);
    if (!options.folder.empty())
        fs::create_directories(options.folder);
    Json rows = Json::array();
    Json pictures = Json::array(), passes = Json::array();
    for (const GiBenchScene& part : giBenchScenes(options)) {
        if (!report.wants(part.name))
            continue;
        const Scene scene = openScene(part.files);
        GiMeasureSettings settings = options.common.quick ? smallGiMeasure() : GiMeasureSettings{};
        settings.cache = options.folder;
        if (!part.camera.empty())
            settings.camera = chooseCamera(scene, part.camera);
        std::fprintf(stderr, "scene     %s\n", part.name.c_str());
        const auto keep = [&](const GiStudy& soFar) { // an interruption leaves what is done
            Json some = rows;
            addGiRows(some, part.name, soFar);
            report.setRows(std::move(some));
            report.write();
        };
        const GiStudy study = studyGi(
            context, scene, options.common.quick ? smallGiSweep() : GiSweep{}, settings, keep);
        addGiRows(rows, part.name, study);
        passes.push_back(passesOf(part.name, study.frame, study.savings));
        printSkipped(part.name, study);
        if (!options.folder.empty())
            pictures.push_back(savePictures(options.folder, part.name, study));
    }
    if (rows.empty())
        throw Error("--filter: no scene's name holds '" + options.common.filter + "'");
    addClosedFormRows(rows);
    const Json facts = giFacts(rows);
    print(rows, facts);
    Json& about = report.about();
    about["facts"] = facts;
    about["columns"] = giColumns();
    about["plots"] = giPlots(rows);
    about["tables"] = giTables();
    about["pictures"] = pictures;
    about["passes"] = passes;
    report.setRows(std::move(rows));
    report.write();
}

Command addBenchGi(CLI::App& bench)
{
    CLI::App* app =
        bench.add_subcommand("gi", "Bytes, bake and shading time of baked light against its error");
    const auto o = std::make_shared<GiBenchOptions>();
    app->add_option("--scene", o->scenes, "Instead of the usual ones; may be given again")
        ->type_name("SCENE")
        ->expected(1)
        ->take_all();
    app->add_option("--env", o->environment, "Distant environment of --scene")->type_name("FILE");
    app->add_option("--data", o->data, "Folder with scenes/ and env/, to study those as well")
        ->type_name("FOLDER")
        ->envname("STRANDLIGHT_DATA");
    app->add_option("--out", o->folder, "For pictures, and truths that are used again")
        ->type_name("FOLDER");
    addBenchOptions(*app, o->common);
    addExamples(*app, "  strandlight bench gi --quick --out out/bench\n"
                      "  strandlight bench gi --scene house.glb --env sky.hdr --json gi.json");
    return {app, [o] {
                benchGi(*o);
                return 0;
            }};
}

} // namespace strandlight::cli
