// Settings of the optimiser, and what changes from step to step.
// Kingma and Ba. Adam: A Method for Stochastic Optimization. 2015
#pragma once

#include <cmath>
#include <cstdint>

namespace strandlight {

struct AdamSettings
{
    double learningRate = 1e-3;
    double beta1 = 0.9;
    double beta2 = 0.999;
    double epsilon = 1e-8;
};

// A gradient beyond this is refused like an infinity: its square would leave fp32.
inline constexpr float kLargestGradient = 1e18f;

struct AdamStep
{
    double stepSize;               // learning rate / (1 - beta1^t)
    double inverseRootCorrection2; // 1 / sqrt(1 - beta2^t)
};

// In double and through expm1: 1 - beta2^t of t = 1 loses five digits in fp32. `step` counts
// from 1.
inline AdamStep adamStepConstants(const AdamSettings& settings, std::uint32_t step)
{
    const double correction1 = -std::expm1(step * std::log(settings.beta1));
    const double correction2 = -std::expm1(step * std::log(settings.beta2));
    return {settings.learningRate / correction1, 1.0 / std::sqrt(correction2)};
}

} // namespace strandlight
