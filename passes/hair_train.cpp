#include "passes/hair_train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/base/byte_stream.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/progress.hpp"
#include "passes/hair_train_step.hpp"

namespace strandlight {
namespace {

constexpr double kLastLearningRate = 0.01; // of the first
constexpr std::array<const char*, 3> kSizes = {"small", "medium", "large"};
constexpr const char* kLosses = "training.losses";
constexpr const char* kValidations = "training.validations";

void check(const HairPool& pool, const HairTrainSettings& s)
{
    const auto refuse = [](const std::string& reason) { throw Error("hair training: " + reason); };
    if (pool.frames.empty())
        refuse("there are no frames to train on");
    const std::uint32_t side = pool.frames.front().size;
    if (s.crop < 8 || s.crop % 8 != 0 || s.crop > side)
        refuse("crops of " + std::to_string(s.crop) +
               " pixels, they must be a multiple of 8 and at most the frames' " +
               std::to_string(side));
    if (s.steps == 0 || s.batch == 0 || s.validateEvery == 0 || s.checkpointEvery == 0)
        refuse("steps, batch and intervals must be at least 1");
    if (!(s.learningRate > 0.0 && s.learningRate <= 1.0))
        refuse("a learning rate of " + std::to_string(s.learningRate));
}

// What a checkpoint must have been made with: all that a step depends on.
std::uint32_t identity(const HairPool& pool, const HairTrainSettings& s)
{
    ByteWriter writer;
    for (const std::uint32_t value :
         {std::uint32_t(s.net), s.steps, s.batch, s.crop, s.seed, s.validateEvery,
          std::uint32_t(pool.frames.size()), std::uint32_t(pool.heldOut.size()), pool.identity})
        writer.value(value);
    writer.value(s.learningRate);
    writer.text(s.initial.string());
    return crc32(writer.bytes());
}

class Trainer
{
public:
    Trainer(Context& context, const HairPool& pool, const HairTrainSettings& settings)
        : context_(context), pool_(pool),
          settings_(settings), training_{hairUNet(settings.net),
                                         Parameters(context, hairUNet(settings.net).parameters(),
                                                    settings.seed),
                                         0,
                                         {},
                                         {},
                                         {}}
    {
        removeStaleTemporaries(settings.checkpoint);
        if (settings.resume && std::filesystem::exists(settings.checkpoint))
            restore();
        else if (!settings.initial.empty())
            training_.parameters.load(Safetensors::load(settings.initial),
                                      settings.initial.string());
    }

    HairTraining run()
    {
        Progress progress("train", settings_.steps);
        progress.update(training_.step);
        while (training_.step < settings_.steps) {
            if (interruptRequested()) {
                save();
                throw Interrupted();
            }
            takeStep();
            if (training_.step % settings_.validateEvery == 0 || training_.step == settings_.steps)
                validate();
            if (training_.step % settings_.checkpointEvery == 0)
                save();
            progress.update(training_.step);
        }
        if (training_.last.frames.empty()) // resumed after the last step
            training_.last = validation();
        return std::move(training_);
    }

private:
    void takeStep()
    {
        const HairBatch batch = drawHairBatch(pool_.frames, settings_.batch, settings_.crop,
                                              settings_.seed, training_.step);
        AdamSettings adam;
        adam.learningRate = hairLearningRate(settings_, training_.step);
        RenderGraph graph(context_);
        ParameterIds ids(graph, training_.parameters);
        const HairLossIds loss =
            addHairTrainingStep(graph, training_.net, ids, batch, adam, training_.step + 1);
        graph.execute();
        training_.losses.push_back(float(loss.value(graph)));
        ++training_.step;
    }

    HairValidation validation()
    {
        return validateHairNet(context_, training_.net, training_.parameters, pool_.heldOut);
    }

    void validate()
    {
        if (pool_.heldOut.empty())
            return;
        training_.last = validation();
        training_.validations.push_back(
            {training_.step, float(training_.last.loss), float(training_.last.relativeError())});
    }

    void save() const
    {
        if (settings_.checkpoint.empty())
            return;
        Safetensors file;
        training_.parameters.save(file, true);
        file.metadata["identity"] = std::to_string(identity(pool_, settings_));
        file.tensors[kLosses] = {{training_.losses.size()}, training_.losses};
        NamedTensor validations{{training_.validations.size(), 3}, {}};
        for (const HairValidationPoint& point : training_.validations)
            for (const float value : {float(point.step), point.loss, point.relativeError})
                validations.values.push_back(value);
        file.tensors[kValidations] = std::move(validations);
        file.save(settings_.checkpoint);
    }

    void restore()
    {
        const std::string path = settings_.checkpoint.string();
        const Safetensors file = Safetensors::load(path);
        const auto made = file.metadata.find("identity");
        if (made == file.metadata.end() ||
            made->second != std::to_string(identity(pool_, settings_)))
            throw FileError(path, "", "made with other frames or settings");
        for (const char* name : {kLosses, kValidations})
            if (!file.has(name))
                throw FileError(path, std::string("tensor \"") + name + "\"", "is missing");
        training_.parameters.load(file, path);
        training_.losses = file.tensors.at(kLosses).values;
        training_.step = std::uint32_t(training_.losses.size());
        const std::vector<float>& points = file.tensors.at(kValidations).values;
        for (std::size_t i = 0; i + 3 <= points.size(); i += 3)
            training_.validations.push_back(
                {std::uint32_t(points[i]), points[i + 1], points[i + 2]});
    }

    Context& context_;
    const HairPool& pool_;
    const HairTrainSettings& settings_;
    HairTraining training_;
};

} // namespace

HairTraining trainHairNet(Context& context, const HairPool& pool, const HairTrainSettings& settings)
{
    check(pool, settings);
    return Trainer(context, pool, settings).run();
}

TrainingMemory hairTrainingMemory(Context& context, const HairTrainSettings& settings)
{
    const UNetDesc net = hairUNet(settings.net);
    Parameters parameters(context, net.parameters(), settings.seed);
    RenderGraph graph(context);
    ParameterIds ids(graph, parameters);
    addHairTrainingStep(graph, net, ids, makeHairBatch(settings.batch, settings.crop), {}, 1);
    return planTrainingMemory(parameters.layout(), graph.compile());
}

double hairLearningRate(const HairTrainSettings& settings, std::uint32_t step)
{
    const double t = double(step) / double(settings.steps);
    const double high = 0.5 * (1.0 + std::cos(std::numbers::pi * t));
    return settings.learningRate * (kLastLearningRate + (1.0 - kLastLearningRate) * high);
}

HairUNetSize hairUNetSizeFrom(const std::string& name)
{
    for (std::size_t i = 0; i < kSizes.size(); ++i)
        if (name == kSizes[i])
            return HairUNetSize(i);
    throw Error("'" + name + "' is not a size of the network: small, medium, large");
}

const char* toString(HairUNetSize size)
{
    return kSizes[std::size_t(size)];
}

} // namespace strandlight
