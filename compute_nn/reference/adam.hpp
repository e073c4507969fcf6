// Plain CPU twin of the optimiser.
// Kingma and Ba. Adam: A Method for Stochastic Optimization. 2015
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compute_nn/adam_settings.hpp"

namespace strandlight::reference {

// One step over a block of parameters; step counts from 1. moment1, moment2 [as parameters] start
// at zero. A gradient that is not finite, or beyond kLargestGradient where its square would
// overflow, leaves everything unchanged; the result says so.
template <class T>
bool adamStep(const AdamSettings& settings, std::uint32_t step, std::span<const T> gradient,
              std::span<T> parameters, std::span<T> moment1, std::span<T> moment2)
{
    for (T g : gradient)
        if (!(std::abs(g) <= T(kLargestGradient)))
            return false;
    const AdamStep now = adamStepConstants(settings, step);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const T g = gradient[i];
        moment1[i] = T(settings.beta1) * moment1[i] + T(1.0 - settings.beta1) * g;
        moment2[i] = T(settings.beta2) * moment2[i] + T(1.0 - settings.beta2) * g * g;
        parameters[i] -=
            T(now.stepSize) * moment1[i] /
            (std::sqrt(moment2[i]) * T(now.inverseRootCorrection2) + T(settings.epsilon));
    }
    return true;
}

} // namespace strandlight::reference
