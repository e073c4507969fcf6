// Plain CPU twins of the activations. The derivative is written in terms of the output y, so that y
// is all that a layer must save. NaN passes through every branch.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "compute_nn/activation_kind.hpp"

namespace strandlight::reference {

// ln(1 + e^x) without overflow for large x and without loss for small.
template <class T> T softplus(T x)
{
    return (x > T(0) ? x : T(0)) + std::log1p(std::exp(-std::abs(x)));
}

// 1 / (1 + e^-x), split by sign so that the exponent is never positive.
template <class T> T sigmoid(T x)
{
    const T e = std::exp(-std::abs(x));
    return (x < T(0) ? e : T(1)) / (T(1) + e);
}

template <class T> T activate(const Activation& a, T x)
{
    switch (a.kind) {
    case ActivationKind::None:
        return x;
    case ActivationKind::Relu:
        return x > T(0) ? x : T(0) * x;
    case ActivationKind::LeakyRelu:
        return x > T(0) ? x : T(a.slope) * x;
    case ActivationKind::Softplus:
        return softplus(x);
    case ActivationKind::Sigmoid:
        return sigmoid(x);
    }
    return x;
}

// dy/dx from y alone. Softplus: y = ln(1+e^x), so dy/dx = e^x / (1+e^x) = 1 - e^-y.
template <class T> T activationDerivative(const Activation& a, T y)
{
    switch (a.kind) {
    case ActivationKind::None:
        return T(1);
    case ActivationKind::Relu:
        return y > T(0) ? T(1) : T(0);
    case ActivationKind::LeakyRelu:
        return y > T(0) ? T(1) : T(a.slope);
    case ActivationKind::Softplus:
        return -std::expm1(-y);
    case ActivationKind::Sigmoid:
        return y * (T(1) - y);
    }
    return T(1);
}

// x, y [any]; y may be x
template <class T> void activationForward(const Activation& a, std::span<const T> x, std::span<T> y)
{
    for (std::size_t i = 0; i < x.size(); ++i)
        y[i] = activate(a, x[i]);
}

// y, dY [any]  ->  accumulates into dX. Saved: y.
template <class T>
void activationBackward(const Activation& a, std::span<const T> y, std::span<const T> dY,
                        std::span<T> dX)
{
    for (std::size_t i = 0; i < y.size(); ++i)
        dX[i] += dY[i] * activationDerivative(a, y[i]);
}

} // namespace strandlight::reference
