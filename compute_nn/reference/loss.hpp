// Plain CPU twins of the losses: value and gradient of a weighted mean over all elements.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compute_nn/loss_kind.hpp"
#include "shaders/shared/nn_types.h"

namespace strandlight::reference {

// Loss of one element and its derivative with respect to the prediction p; t is the target.
template <class T> struct LossTerm
{
    T value;
    T derivative;
};

template <class T> LossTerm<T> lossTerm(LossKind kind, T p, T t)
{
    const T difference = p - t;
    switch (kind) {
    case LossKind::MeanSquare:
        break;
    case LossKind::Relative: {
        // The denominator is a constant for the gradient; it keeps bright and dark elements equally
        // heavy, and its floor keeps black ones finite. Lehtinen et al. Noise2Noise. 2018
        const T weight = T(1) / (p * p + T(gpu::kRelativeLossFloor));
        return {difference * difference * weight, T(2) * difference * weight};
    }
    case LossKind::Log1p: {
        // Radiance is not negative; a prediction below 0 counts as 0 and is pushed up.
        const T q = p < T(0) ? T(0) : p;
        const T distance = std::log1p(q) - std::log1p(t < T(0) ? T(0) : t);
        return {distance * distance, T(2) * distance / (T(1) + q)};
    }
    }
    return {difference * difference, T(2) * difference};
}

// prediction, target [any size]; weights [period] or empty: element i has weight[i / stride %
// period]. Returns sum(weight * loss) / count and accumulates its gradient into dPrediction.
template <class T>
T loss(LossKind kind, std::span<const T> prediction, std::span<const T> target,
       std::span<const T> weights, std::size_t stride, std::span<T> dPrediction)
{
    const T scale = T(1) / T(prediction.size());
    T sum = T(0);
    for (std::size_t i = 0; i < prediction.size(); ++i) {
        const LossTerm<T> term = lossTerm(kind, prediction[i], target[i]);
        const T weight = weights.empty() ? T(1) : weights[i / stride % weights.size()];
        sum += weight * term.value;
        if (!dPrediction.empty())
            dPrediction[i] += weight * term.derivative * scale;
    }
    return sum * scale;
}

} // namespace strandlight::reference
