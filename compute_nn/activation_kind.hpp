// The activation functions a layer may end with.
#pragma once

#include <cstdint>

namespace strandlight {

// The values are part of the kernels (shaders/nn/nn_math.glsl).
enum class ActivationKind : std::uint32_t
{
    None,
    Relu,
    LeakyRelu, // slope below zero from `slope`
    Softplus,
    Sigmoid
};

struct Activation
{
    ActivationKind kind = ActivationKind::None;
    float slope = 0.1f; // LeakyRelu only

    static Activation none() { return {}; }
    static Activation leakyRelu(float slope) { return {ActivationKind::LeakyRelu, slope}; }
};

} // namespace strandlight
