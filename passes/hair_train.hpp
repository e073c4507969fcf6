// Trains the filter network on a pool of frames. Step k depends on (seed, k) and the weights alone,
// so a run that was stopped goes on to the same bytes.
// Loshchilov, Hutter. SGDR: Stochastic Gradient Descent with Warm Restarts. 2017 (cosine decay)
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "compute_nn/training_memory.hpp"
#include "passes/hair_training_pool.hpp"
#include "passes/hair_validation.hpp"

namespace strandlight {

struct HairTrainSettings
{
    HairUNetSize net = HairUNetSize::Medium;
    std::uint32_t steps = 6000;
    std::uint32_t batch = 8;           // crops a step
    std::uint32_t crop = 64;           // pixels a side, a multiple of 8
    double learningRate = 2e-3;        // falls to a hundredth as a cosine
    std::uint32_t seed = 1;            // of weights, crops and augmentations
    std::uint32_t validateEvery = 500; // steps
    std::uint32_t checkpointEvery = 250;
    std::filesystem::path checkpoint; // empty: none
    bool resume = false;              // from the checkpoint, if it is there
    std::filesystem::path initial;    // weights to start from; empty: drawn from the seed
};

struct HairValidationPoint
{
    std::uint32_t step = 0;
    float loss = 0.0f;
    float relativeError = 0.0f; // HairValidation::relativeError
};

struct HairTraining
{
    UNetDesc net;
    Parameters parameters;
    std::uint32_t step = 0;    // taken or skipped
    std::vector<float> losses; // [step]
    std::vector<HairValidationPoint> validations;
    HairValidation last; // after the last step; no frames without held-out frames
};

// Throws Error for settings out of range, FileError for a checkpoint or initial weights that do not
// fit, Interrupted when the user stops: the checkpoint then holds all steps taken.
HairTraining trainHairNet(Context& context, const HairPool& pool,
                          const HairTrainSettings& settings);

// What a step with these settings will allocate: net, batch and crop. Throws Error for a size that
// the network does not take.
TrainingMemory hairTrainingMemory(Context& context, const HairTrainSettings& settings);

double hairLearningRate(const HairTrainSettings& settings, std::uint32_t step); // from 0

HairUNetSize hairUNetSizeFrom(const std::string& name); // throws Error
const char* toString(HairUNetSize size);

} // namespace strandlight
