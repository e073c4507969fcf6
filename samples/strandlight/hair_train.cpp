// strandlight hair train: the filter network's weights from procedural grooms.
#include <charconv>
#include <chrono>
#include <cstdio>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/image_io.hpp"
#include "passes/hair_train.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/loss_curve.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

namespace fs = std::filesystem;

struct Options
{
    DeviceOptions device;
    HairPoolSettings pool;
    HairTrainSettings train;
    std::string data;
    std::string net = toString(HairUNetSize::Medium);
    std::string initial;
    std::string output;
    std::string curve;
    std::string pictures;
    std::string json;
    bool memory = false;
};

// The shortest text that is read as the same number.
std::string exactly(auto value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof(text), value).ptr};
}

// What makes the same weights again, given folders.
std::string commandLine(const Options& o)
{
    const HairTrainSettings& t = o.train;
    std::string line = "strandlight hair train";
    const auto add = [&](const char* name, const auto& value) {
        line += std::string(" ") + name + " " + std::to_string(value);
    };
    add("--data-seed", o.pool.seed);
    add("--first-frame", o.pool.first);
    add("--frames", o.pool.frames);
    add("--frame-size", o.pool.frame.size);
    add("--target-spp", o.pool.frame.targetSamples);
    line += " --strand-share " + exactly(o.pool.frame.strandShare) + " --net " + o.net;
    add("--steps", t.steps);
    add("--batch", t.batch);
    add("--crop", t.crop);
    line += " --rate " + exactly(t.learningRate);
    add("--seed", t.seed);
    if (!o.initial.empty())
        line += " --init " + fs::path(o.initial).filename().string();
    return line;
}

void saveWeights(const Options& o, const HairTraining& training)
{
    Safetensors file;
    training.parameters.save(file, false);
    file.metadata = {{"network", "hair filter, " + o.net},
                     {"channels", std::to_string(training.net.in) + " in, " +
                                      std::to_string(training.net.out) + " out"},
                     {"command", commandLine(o)},
                     {"commit", commit()}};
    file.save(o.output);
}

void printErrors(const HairPool& pool, const HairValidation& validation)
{
    std::printf("held out                 4 averaged       16       64  network  network/4\n");
    for (std::size_t i = 0; i < validation.frames.size(); ++i) {
        const HairFrameErrors& e = validation.frames[i];
        std::printf("%-24s %10.5f %8.5f %8.5f %8.5f %10.3f\n", pool.heldOutNames[i].c_str(),
                    e.average4, e.average16, e.average64, e.network, e.network / e.average4);
    }
    std::printf("%-24s %49.3f\n", "mean", validation.relativeError());
}

Json describe(const Options& o, const Context& context, const HairPool& pool,
              const HairTraining& training, double seconds)
{
    Json json = describeRun("hair train", &context);
    json["settings"] = {{"command", commandLine(o)},
                        {"frames", pool.frames.size()},
                        {"parameters", training.net.parameters().count()}};
    Json errors = Json::array();
    for (std::size_t i = 0; i < training.last.frames.size(); ++i) {
        const HairFrameErrors& e = training.last.frames[i];
        errors.push_back({{"frame", pool.heldOutNames[i]},
                          {"rmse_average_4", e.average4},
                          {"rmse_average_16", e.average16},
                          {"rmse_average_64", e.average64},
                          {"rmse_network", e.network}});
    }
    Json validations = Json::array();
    for (const HairValidationPoint& point : training.validations)
        validations.push_back(
            {{"step", point.step}, {"loss", point.loss}, {"relative_error", point.relativeError}});
    const OptimizerReport report = training.parameters.report();
    json["result"] = {{"file", o.output},
                      {"last_loss", training.losses.back()},
                      {"skipped_steps", report.stepsSkipped},
                      {"refused_in", report.refusedIn},
                      {"validations", validations},
                      {"held_out", errors},
                      {"seconds", seconds}};
    return json;
}

void savePictures(const Options& o, Context& context, const HairPool& pool, HairTraining& training)
{
    for (std::size_t i = 0; i < pool.heldOut.size(); ++i)
        savePng(fs::path(o.pictures) / ("heldout_" + std::to_string(i) + ".png"),
                hairValidationPicture(context, training.net, training.parameters, pool.heldOut[i]));
}

int run(Options& o)
{
    const auto start = std::chrono::steady_clock::now();
    requireOutput(o.output, {".safetensors"});
    requireOutput(o.curve, {".svg"});
    requireOutput(o.json, {".json"});
    if (!o.pictures.empty() && !fs::is_directory(o.pictures))
        throw FileError(o.pictures, "", "is not a folder");
    o.pool.folder = o.data;
    o.train.net = hairUNetSizeFrom(o.net);
    o.train.initial = o.initial;
    if (!o.initial.empty())
        Safetensors::load(o.initial); // a broken file is refused before the long work
    o.train.checkpoint = o.output + ".checkpoint";
    Context context = openDevice(o.device);
    if (o.memory) {
        std::printf("%s network, one training step of %u crops of %u pixels\n%s", o.net.c_str(),
                    o.train.batch, o.train.crop, hairTrainingMemory(context, o.train).text.c_str());
        return 0;
    }

    const HairPool pool = openHairPool(context, o.pool);
    HairTraining training = trainHairNet(context, pool, o.train);
    saveWeights(o, training);
    if (!o.curve.empty())
        writeFileAtomically(o.curve, lossCurveSvg(training));
    if (!o.pictures.empty())
        savePictures(o, context, pool, training);
    fs::remove(o.train.checkpoint);

    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    printErrors(pool, training.last);
    const OptimizerReport report = training.parameters.report();
    for (std::size_t i = 0; i < report.refusedIn.size(); ++i)
        std::printf("refused   %u values of %s\n", report.refused[i], report.refusedIn[i].c_str());
    std::printf("wrote     %s, %u steps, %u skipped, %.1f s\n", o.output.c_str(), training.step,
                report.stepsSkipped, elapsed.count());
    writeJson(o.json, describe(o, context, pool, training, elapsed.count()));
    return 0;
}

void addDataOptions(CLI::App& app, Options& o)
{
    app.add_option("--data", o.data, "Frames are kept here; those that lack are rendered first")
        ->required()
        ->type_name("FOLDER");
    addNumber(app, "--frames", o.pool.frames, "To train on", 1u, 100000u);
    addNumber(app, "--first-frame", o.pool.first, "Number of the first of them", 0u, 1000000u);
    addNumber(app, "--held-out", o.pool.heldOut, "To judge by, of other grooms", 0u, 1000u);
    addNumber(app, "--frame-size", o.pool.frame.size, "Pixels a side", 8u, 2048u);
    addNumber(app, "--target-spp", o.pool.frame.targetSamples,
              "Samples of the truth; held-out frames take four times as many", 8u, 16384u);
    addNumber(app, "--data-seed", o.pool.seed, "Of the frames", 0u, ~0u);
    app.add_option("--strand-share", o.pool.frame.strandShare, "Of the frames' strands, in (0, 1]")
        ->type_name("N")
        ->capture_default_str();
}

void addTrainOptions(CLI::App& app, Options& o)
{
    HairTrainSettings& t = o.train;
    app.add_option("--net", o.net, "Size of the network")
        ->type_name("SIZE")
        ->capture_default_str()
        ->check(CLI::IsMember({"small", "medium", "large"}));
    addNumber(app, "--steps", t.steps, "Of the optimiser", 1u, 10000000u);
    addNumber(app, "--batch", t.batch, "Crops a step", 1u, 256u);
    addNumber(app, "--crop", t.crop, "Their side in pixels, a multiple of 8", 8u, 2048u);
    app.add_option("--rate", t.learningRate, "Learning rate at the start")
        ->type_name("N")
        ->capture_default_str();
    addNumber(app, "--seed", t.seed, "Of weights, crops and augmentations", 0u, ~0u);
    addNumber(app, "--validate-every", t.validateEvery, "Steps", 1u, 10000000u);
    addNumber(app, "--checkpoint-every", t.checkpointEvery, "Steps", 1u, 10000000u);
    app.add_option("--init", o.initial, "Weights to start from")->type_name("FILE");
    app.add_flag("--resume", t.resume, "Go on from the checkpoint of an interrupted training");
}

} // namespace

Command addHairTrain(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("train", "Weights of the filter network");
    const auto o = std::make_shared<Options>();
    app->add_option("-o,--output", o->output, "The weights, .safetensors")
        ->required()
        ->type_name("FILE");
    addDataOptions(*app, *o);
    addTrainOptions(*app, *o);
    app->add_option("--curve", o->curve, "Losses by step, .svg")->type_name("FILE");
    app->add_option("--pictures", o->pictures,
                    "4 and 64 samples averaged, the network's, the truth, of held-out frames")
        ->type_name("FOLDER");
    app->add_flag("--memory", o->memory, "Only print what a training step will allocate");
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app, "  strandlight hair train --data frames -o net.safetensors --curve loss.svg\n"
                      "  strandlight hair train --data frames --frames 8 --steps 500 --net small "
                      "-o small.safetensors\n"
                      "Ctrl-C keeps the frames made so far and net.safetensors.checkpoint; the "
                      "same command with --resume goes on to the same bytes.");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
