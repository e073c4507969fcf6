// Axis coding: Cigolle et al. A Survey of Efficient Representations for Independent Unit Vectors.
// 2014
#include "passes/sgl_lobe.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <glm/gtc/packing.hpp>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "shaders/shared/octahedral.h"
#include "shaders/shared/rgb9e5.h"

namespace strandlight {

namespace {

std::uint32_t quantise(float unit, std::uint32_t maximum)
{
    const float value = std::clamp(unit, 0.0f, 1.0f) * static_cast<float>(maximum) + 0.5f;
    return static_cast<std::uint32_t>(value);
}

float dequantise(std::uint32_t value, std::uint32_t maximum)
{
    return static_cast<float>(value) / static_cast<float>(maximum);
}

// An odd number of steps less one, so that 0.5, the axis N of the frame, is stored exactly.
constexpr std::uint32_t axisMaximum(SglStorage storage)
{
    return storage == SglStorage::Fp16 ? 65534u : 4094u;
}

void checkLobe(const SgLobe& lobe, std::size_t index, std::uint32_t lobeCount)
{
    const std::string place = "texel " + std::to_string(index / lobeCount) + ", lobe " +
                              std::to_string(index % lobeCount);
    const glm::vec3& a = lobe.amplitude;
    const bool finite = std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z) &&
                        std::isfinite(lobe.logSharpness);
    if (!finite)
        throw Error(place + " has a value that is not finite");
    const float brightest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    if (brightest > kSglLargestAmplitude) // rounded up, the largest floats would become infinite
        throw Error(place + " has an amplitude of " + std::to_string(brightest));
    const float length = glm::length(lobe.axis);
    if (!(length >= 0.9f && length <= 1.1f))
        throw Error(place + " has an axis of length " + std::to_string(length));
    if (std::abs(lobe.logSharpness) > kSglMaximumLogSharpness)
        throw Error(place + " has a ln sharpness of " + std::to_string(lobe.logSharpness));
}

} // namespace

SglLobeCoding chooseCoding(const SgField& field, SglStorage storage)
{
    SglLobeCoding coding{.storage = storage};
    float brightest = 0.0f;
    bool any = false;
    for (std::size_t i = 0; i < field.lobes.size(); ++i) {
        if ((field.keptBy(i / field.lobeCount) >> (i % field.lobeCount) & 1u) == 0u)
            continue;
        const SgLobe& lobe = field.lobes[i];
        checkLobe(lobe, i, field.lobeCount);
        if (!any)
            coding.logSharpnessLow = coding.logSharpnessHigh = lobe.logSharpness;
        any = true;
        brightest = std::max({brightest, std::abs(lobe.amplitude.x), std::abs(lobe.amplitude.y),
                              std::abs(lobe.amplitude.z)});
        coding.logSharpnessLow = std::min(coding.logSharpnessLow, lobe.logSharpness);
        coding.logSharpnessHigh = std::max(coding.logSharpnessHigh, lobe.logSharpness);
    }
    // Kept normal, so that a field of almost no light does not divide by a denormal.
    if (brightest > 0.0f)
        coding.amplitudeScale = std::ldexp(1.0f, std::max(std::ilogb(brightest) - 14, -100));
    return coding;
}

bool encodeLobe(const SgLobe& lobe, const SglLobeCoding& coding, std::span<std::uint8_t> out)
{
    STRANDLIGHT_ASSERT_EQ(out.size(), sglBytesPerLobe(coding.storage));
    const glm::vec2 axis = gpu::octEncode(lobe.axis);
    const std::uint32_t u = quantise(axis.x, axisMaximum(coding.storage));
    const std::uint32_t v = quantise(axis.y, axisMaximum(coding.storage));
    const glm::vec3 amplitude = lobe.amplitude / coding.amplitudeScale;

    if (coding.storage == SglStorage::Fp16) {
        const std::uint16_t words[6] = {
            static_cast<std::uint16_t>(u),        static_cast<std::uint16_t>(v),
            glm::packHalf1x16(lobe.logSharpness), glm::packHalf1x16(amplitude.x),
            glm::packHalf1x16(amplitude.y),       glm::packHalf1x16(amplitude.z)};
        std::memcpy(out.data(), words, sizeof(words));
        return false;
    }
    const float range = coding.logSharpnessHigh - coding.logSharpnessLow;
    const float unit = range > 0.0f ? (lobe.logSharpness - coding.logSharpnessLow) / range : 0.0f;
    const std::uint32_t words[2] = {u | v << 12 | quantise(unit, 255) << 24,
                                    gpu::packRgb9e5(amplitude)};
    std::memcpy(out.data(), words, sizeof(words));
    return gpu::rgb9e5Clamps(amplitude);
}

SgLobe decodeLobe(std::span<const std::uint8_t> in, const SglLobeCoding& coding)
{
    STRANDLIGHT_ASSERT_EQ(in.size(), sglBytesPerLobe(coding.storage));
    const std::uint32_t maximum = axisMaximum(coding.storage);
    SgLobe lobe;
    if (coding.storage == SglStorage::Fp16) {
        std::uint16_t words[6];
        std::memcpy(words, in.data(), sizeof(words));
        lobe.axis = gpu::octDecode({dequantise(words[0], maximum), dequantise(words[1], maximum)});
        lobe.logSharpness = glm::unpackHalf1x16(words[2]);
        lobe.amplitude = glm::vec3(glm::unpackHalf1x16(words[3]), glm::unpackHalf1x16(words[4]),
                                   glm::unpackHalf1x16(words[5]));
    } else {
        std::uint32_t words[2];
        std::memcpy(words, in.data(), sizeof(words));
        lobe.axis = gpu::octDecode(
            {dequantise(words[0] & 0xFFFu, maximum), dequantise(words[0] >> 12 & 0xFFFu, maximum)});
        lobe.logSharpness = glm::mix(coding.logSharpnessLow, coding.logSharpnessHigh,
                                     dequantise(words[0] >> 24, 255));
        lobe.amplitude = gpu::unpackRgb9e5(words[1]);
    }
    lobe.amplitude *= coding.amplitudeScale;
    return lobe;
}

} // namespace strandlight
