// How one lobe is stored in an .sgl file: 12 bytes (fp16) or 8 (packed).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "passes/sg_field.hpp"

namespace strandlight {

enum class SglStorage : std::uint32_t
{
    Fp16 = 0, // axis octahedral 2 x 16 bits, ln sharpness and amplitude fp16: 12 bytes per lobe
    Packed =
        1 // axis octahedral 2 x 12 bits, ln sharpness 8 bits, amplitude RGB9E5: 8 bytes per lobe
};

// Common to all lobes of a field. Amplitudes are divided by `amplitudeScale`, a power of two that
// brings the largest to [2^14, 2^15), so neither format overflows; smaller ones lose precision
// below 2^-29 (fp16) or 2^-39 (packed) of it.
struct SglLobeCoding
{
    SglStorage storage = SglStorage::Fp16;
    float amplitudeScale = 1.0f;
    float logSharpnessLow = 0.0f; // the 8 bits of the packed format span this range
    float logSharpnessHigh = 0.0f;
};

constexpr std::size_t sglBytesPerLobe(SglStorage storage)
{
    return storage == SglStorage::Fp16 ? 12 : 8;
}

// Of the mask of a tile: a bit for each lobe.
constexpr std::size_t sglMaskBytes(std::uint32_t lobeCount)
{
    return (lobeCount + 7) / 8;
}

// Chooses scale and range of the kept lobes. Throws Error, naming the texel, for a lobe that is not
// finite or brighter than kSglLargestAmplitude, whose axis length is outside [0.9, 1.1] or whose ln
// sharpness is outside [-16, 16].
SglLobeCoding chooseCoding(const SgField& field, SglStorage storage);

// `out` holds sglBytesPerLobe() bytes. Returns whether a value was clamped: the packed format has
// no negative amplitude.
bool encodeLobe(const SgLobe& lobe, const SglLobeCoding& coding, std::span<std::uint8_t> out);
SgLobe decodeLobe(std::span<const std::uint8_t> in, const SglLobeCoding& coding);

// |ln sharpness| beyond this is no light: lambda from 1e-7 (constant) to 9e6 (a hundredth of a
// degree).
inline constexpr float kSglMaximumLogSharpness = 16.0f;
inline constexpr float kSglLargestAmplitude = 1e37f;

} // namespace strandlight
