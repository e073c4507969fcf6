// Minimal filtering: correlations by few products are the correlations, to rounding.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "shaders/shared/minimal_filter.h"
#include "shaders/shared/rng.h"

using namespace strandlight;

namespace {

constexpr int kTrials = 200;

float value(int trial, std::uint32_t i)
{
    return 2.0f * gpu::uniform3(i, std::uint32_t(trial), 7, 0).x - 1.0f;
}

struct Errors
{
    double minimal = 0.0, plain = 0.0; // squares, of sums over channels
};

// Sums over 64 channels against double: at the points, and term by term in floats.
Errors errorsOf(int trial)
{
    constexpr int kChannels = 64;
    gpu::MinimalPoints sums{};
    std::array<double, 4> wanted{};
    std::array<float, 4> plain{};
    for (int c = 0; c < kChannels; ++c) {
        float d[6], w[3];
        for (gpu::uint i = 0; i < 6; ++i)
            d[i] = value(trial, c * 16 + i);
        for (gpu::uint i = 0; i < 3; ++i)
            w[i] = value(trial, c * 16 + 8 + i);
        const gpu::MinimalPoints v = gpu::minimalInputs(d);
        for (gpu::uint j = 0; j < gpu::kMinimalPoints; ++j)
            sums.at[j] += gpu::minimalWeight(j, w[0], w[1], w[2]) * v.at[j];
        for (gpu::uint i = 0; i < 4; ++i)
            for (gpu::uint k = 0; k < 3; ++k) {
                wanted[i] += double(d[i + k]) * w[k];
                plain[i] += d[i + k] * w[k];
            }
    }
    const glm::vec4 y = gpu::minimalResults(sums);
    Errors errors;
    for (int i = 0; i < 4; ++i) {
        errors.minimal += std::pow(y[i] - wanted[i], 2);
        errors.plain += std::pow(plain[i] - wanted[i], 2);
    }
    return errors;
}

} // namespace

TEST_CASE("minimal filter: four results of three taps, with at most twice the rounding")
{
    Errors all;
    for (int trial = 0; trial < kTrials; ++trial) {
        const Errors one = errorsOf(trial);
        all.minimal += one.minimal;
        all.plain += one.plain;
    }
    const double rms = std::sqrt(all.minimal / (4 * kTrials));
    CHECK_LT(rms, 2e-6); // of sums of 192 products of about 1/3
    CHECK_GT(rms, 0.0);
    CHECK_LT(std::sqrt(all.minimal / all.plain), 2.0);
    MESSAGE(std::sqrt(all.minimal / all.plain) << " times the plain sum's rounding");
}

TEST_CASE("minimal filter: the gradient of three weights from tiles of four pixels")
{
    for (int trial = 0; trial < kTrials; ++trial) {
        gpu::MinimalPoints sums{};
        std::array<double, 3> wanted{};
        double size = 0.0;
        for (int tile = 0; tile < 64; ++tile) {
            float d[6];
            for (int i = 0; i < 6; ++i)
                d[i] = value(trial, tile * 16 + i);
            glm::vec4 s;
            for (int i = 0; i < 4; ++i)
                s[i] = value(trial, tile * 16 + 8 + i);
            const gpu::MinimalPoints u = gpu::minimalFilter(s), v = gpu::minimalInputs(d);
            for (int j = 0; j < 6; ++j)
                sums.at[j] += u.at[j] * v.at[j];
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 4; ++i) {
                    wanted[k] += double(s[i]) * d[i + k];
                    size += std::abs(double(s[i]) * d[i + k]) / 3.0;
                }
        }
        const glm::vec3 y = gpu::minimalTaps(sums);
        for (int k = 0; k < 3; ++k)
            CHECK_LT(std::abs(y[k] - wanted[k]), 1e-6 * size);
    }
}

TEST_CASE("minimal filter: a pixel reaches the results whose taps meet it, and no other")
{
    for (gpu::uint i = 0; i < 6; ++i) {
        float d[6] = {};
        d[i] = 4.0f;
        const gpu::MinimalPoints v = gpu::minimalInputs(d);
        gpu::MinimalPoints m{};
        for (gpu::uint j = 0; j < gpu::kMinimalPoints; ++j)
            m.at[j] = gpu::minimalWeight(j, 0.5f, 0.0f, 0.0f) * v.at[j];
        const glm::vec4 y = gpu::minimalResults(m);
        for (gpu::uint k = 0; k < 4; ++k)
            CHECK(y[k] == doctest::Approx(k == i ? 2.0f : 0.0f).epsilon(1e-6));
    }
}
