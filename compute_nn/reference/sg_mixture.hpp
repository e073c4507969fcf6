// Plain CPU twins of the spherical-gaussian decoder and mixture.
// Wang et al. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009
// Currius, Dolonius, Assarsson, Sintorn. Spherical Gaussian Light-field Textures for Fast
// Precomputed GI. 2020
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compute_nn/reference/activation.hpp"
#include "shaders/shared/nn_types.h"

namespace strandlight::reference {

// One decoded lobe: radiance(d) = amplitude exp(-sharpness/2 |d - axis|^2)
template <class T> struct Lobe
{
    std::array<T, 3> axis{};
    T sharpness = T(0);
    std::array<T, 3> amplitude{};
};

// Length of raw[0..2], scaled so that neither 1e-30 nor 1e30 squares out of range; 0 means: no
// direction.
template <class T> T rawAxisLength(std::span<const T> raw)
{
    T largest = T(0);
    for (int k = 0; k < 3; ++k)
        largest = std::abs(raw[k]) > largest ? std::abs(raw[k]) : largest;
    if (largest <= T(gpu::kSgTinyAxis))
        return std::isnan(raw[0] + raw[1] + raw[2]) ? raw[0] + raw[1] + raw[2] : T(0);
    T squares = T(0);
    for (int k = 0; k < 3; ++k)
        squares += (raw[k] / largest) * (raw[k] / largest);
    return largest * std::sqrt(squares);
}

// raw [7] -> lobe: axis = normalize(raw[0..2]), sharpness = exp(clamp(raw[3] + 2)), amplitude =
// softplus(raw[4..6]). An axis without direction decodes to +z.
template <class T> Lobe<T> decodeLobe(std::span<const T> raw)
{
    Lobe<T> lobe;
    const T length = rawAxisLength(raw);
    for (int k = 0; k < 3; ++k)
        lobe.axis[k] = length == T(0) ? T(k == 2) : raw[k] / length;
    const T exponent = raw[3] + T(gpu::kSgSharpnessOffset);
    lobe.sharpness = std::exp(exponent < T(gpu::kSgMinimumExponent)   ? T(gpu::kSgMinimumExponent)
                              : exponent > T(gpu::kSgMaximumExponent) ? T(gpu::kSgMaximumExponent)
                                                                      : exponent);
    for (int k = 0; k < 3; ++k)
        lobe.amplitude[k] = softplus(raw[4 + k]);
    return lobe;
}

// dLobe -> accumulates into dRaw [7]. Saved: raw. Clamped exponents and missing axes have no
// gradient.
template <class T>
void decodeLobeBackward(std::span<const T> raw, const Lobe<T>& dLobe, std::span<T> dRaw)
{
    const Lobe<T> lobe = decodeLobe(raw);
    const T length = rawAxisLength(raw);
    const T along =
        dLobe.axis[0] * lobe.axis[0] + dLobe.axis[1] * lobe.axis[1] + dLobe.axis[2] * lobe.axis[2];
    if (length != T(0))
        for (int k = 0; k < 3; ++k)
            dRaw[k] += (dLobe.axis[k] - lobe.axis[k] * along) / length;
    const T exponent = raw[3] + T(gpu::kSgSharpnessOffset);
    if (!(exponent < T(gpu::kSgMinimumExponent)) && !(exponent > T(gpu::kSgMaximumExponent)))
        dRaw[3] += dLobe.sharpness * lobe.sharpness;
    for (int k = 0; k < 3; ++k)
        dRaw[4 + k] += dLobe.amplitude[k] * sigmoid(raw[4 + k]);
}

// One mixture: raw [L,7], direction [3] (unit) -> adds sum over lobes to radiance [3].
template <class T>
void sgMixture(std::span<const T> raw, std::span<const T> direction, std::span<T> radiance)
{
    for (std::size_t l = 0; l < raw.size() / 7; ++l) {
        const Lobe<T> lobe = decodeLobe(raw.subspan(l * 7, 7));
        T chord = T(0); // |d - axis|^2 = 2 - 2 cos, without its cancellation for sharp lobes
        for (int k = 0; k < 3; ++k)
            chord += (direction[k] - lobe.axis[k]) * (direction[k] - lobe.axis[k]);
        const T weight = std::exp(T(-0.5) * lobe.sharpness * chord);
        for (int k = 0; k < 3; ++k)
            radiance[k] += lobe.amplitude[k] * weight;
    }
}

// dRadiance [3] -> accumulates into dRaw [L,7]. Saved: raw, direction.
template <class T>
void sgMixtureBackward(std::span<const T> raw, std::span<const T> direction,
                       std::span<const T> dRadiance, std::span<T> dRaw)
{
    for (std::size_t l = 0; l < raw.size() / 7; ++l) {
        const Lobe<T> lobe = decodeLobe(raw.subspan(l * 7, 7));
        T chord = T(0);
        for (int k = 0; k < 3; ++k)
            chord += (direction[k] - lobe.axis[k]) * (direction[k] - lobe.axis[k]);
        const T weight = std::exp(T(-0.5) * lobe.sharpness * chord);

        Lobe<T> dLobe;
        T dExponent = T(0);
        for (int k = 0; k < 3; ++k) {
            dLobe.amplitude[k] = dRadiance[k] * weight;
            dExponent += dRadiance[k] * lobe.amplitude[k] * weight;
        }
        dLobe.sharpness = dExponent * T(-0.5) * chord;
        for (int k = 0; k < 3; ++k) // in R^3; the decoder keeps the part tangent to the sphere
            dLobe.axis[k] = dExponent * lobe.sharpness * (direction[k] - lobe.axis[k]);
        decodeLobeBackward(raw.subspan(l * 7, 7), dLobe, dRaw.subspan(l * 7, 7));
    }
}

} // namespace strandlight::reference
