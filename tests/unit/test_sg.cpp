// SG algebra in fp32 against double: relative error over the whole range of sharpness, and special
// values.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include <doctest/doctest.h>

#include "shaders/shared/sg.h"

namespace gpu = strandlight::gpu;
using glm::dvec3;
using glm::vec3;

namespace {

// Axis, and a second unit vector `angle` away from it in a random direction.
void directionPair(std::mt19937& rng, double angle, vec3& a, vec3& b)
{
    std::normal_distribution<double> normal;
    const dvec3 axis = glm::normalize(dvec3(normal(rng), normal(rng), normal(rng)));
    dvec3 other(normal(rng), normal(rng), normal(rng));
    other = glm::normalize(other - axis * glm::dot(axis, other));
    a = vec3(axis);
    b = vec3(axis * std::cos(angle) + other * std::sin(angle));
}

double exactIntegral(double lambda)
{
    return lambda == 0.0 ? 4.0 * M_PI : -2.0 * M_PI * std::expm1(-2.0 * lambda) / lambda;
}

// Integral of the product of two SGs whose fp32 axes are taken as given and renormalised in double.
double exactInnerProduct(const vec3& a, double la, const vec3& b, double lb)
{
    const dvec3 da = glm::normalize(dvec3(a));
    const dvec3 db = glm::normalize(dvec3(b));
    const double sum = glm::length(da * la + db * lb);
    const double chord = glm::dot(da - db, da - db);
    return std::exp(-la * lb * chord / (sum + la + lb)) * exactIntegral(sum);
}

} // namespace

TEST_CASE("sg: (1 - exp(-x)) / x is exact to fp32 everywhere")
{
    CHECK(gpu::oneMinusExpOverX(0.0f) == 1.0f);
    double worst = 0.0;
    for (double x = 1e-9; x < 1e6; x *= 1.07) {
        const float xf = float(x);
        const double exact = -std::expm1(-double(xf)) / double(xf);
        worst = std::max(worst, std::abs(gpu::oneMinusExpOverX(xf) / exact - 1.0));
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("sg: integral over lambda 0, 1e-8 .. 1e6")
{
    CHECK(gpu::sgIntegral(0.0f) == doctest::Approx(4.0 * M_PI).epsilon(1e-7));
    double worst = 0.0;
    for (double l = 1e-8; l < 1e6; l *= 1.1)
        worst =
            std::max(worst, std::abs(gpu::sgIntegral(float(l)) / exactIntegral(float(l)) - 1.0));
    CHECK(worst < 1e-6);
}

TEST_CASE("sg: value never exceeds the amplitude and keeps its digits")
{
    std::mt19937 rng(1);
    for (const double lambda : {1e-3, 1.0, 1e2, 1e4, 1e6}) {
        double worst = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const double sigma = 1.0 / std::sqrt(lambda);
            const double angle = std::min(M_PI, 4.0 * sigma * (i % 50) / 50.0);
            vec3 a;
            vec3 d;
            directionPair(rng, angle, a, d);
            const dvec3 chord = glm::normalize(dvec3(d)) - glm::normalize(dvec3(a));
            const double exact = std::exp(-0.5 * lambda * glm::dot(chord, chord));
            const float value = gpu::sgEvaluate(d, a, float(lambda));
            CHECK(value <= 1.0f);
            worst = std::max(worst, std::abs(value / exact - 1.0));
        }
        CAPTURE(lambda);
        // Rounding of the fp32 axes moves the chord by ~1e-7; at 4 sigma that is 4e-7 sqrt(lambda)
        // of the value.
        CHECK(worst < 2e-5 + 1.2e-6 * std::sqrt(lambda));
    }
}

TEST_CASE("sg: inner product, from opposed to 1e-6 apart")
{
    std::mt19937 rng(2);
    for (const double la : {1e-3, 1.0, 40.0, 1e2, 1e4})
        for (const double lb : {1e-3, 1.0, 40.0, 1e4})
            for (const double angle : {0.0, 1e-6, 1e-3, 0.1, 1.0, 3.0, M_PI}) {
                vec3 a;
                vec3 b;
                directionPair(rng, angle, a, b);
                const double exact = exactInnerProduct(a, la, b, lb);
                const float value = gpu::sgInnerProduct(a, float(la), b, float(lb));
                CAPTURE(la);
                CAPTURE(lb);
                CAPTURE(angle);
                REQUIRE(std::isfinite(value));
                // The exponent can be large; its fp32 rounding is relative to it. Below 1e-30 only
                // "tiny" counts.
                if (exact > 1e-30)
                    CHECK(std::abs(value / exact - 1.0) < 1e-4);
                else
                    CHECK(value < 1e-29f);
            }
}

TEST_CASE("sg: product is pointwise the product")
{
    std::mt19937 rng(3);
    for (const double la : {0.1, 5.0, 300.0})
        for (const double lb : {0.1, 5.0, 300.0})
            for (int i = 0; i < 200; ++i) {
                vec3 a;
                vec3 b;
                vec3 d;
                vec3 unused;
                directionPair(rng, 0.02 * i / std::sqrt(std::max({la, lb, 1.0})), a, b);
                directionPair(rng, 0.3, d, unused);
                vec3 axis;
                float lambda = 0.0f;
                float logAmplitude = 0.0f;
                gpu::sgProduct(a, float(la), b, float(lb), axis, lambda, logAmplitude);
                const float product = std::exp(logAmplitude) * gpu::sgEvaluate(d, axis, lambda);
                const float factors =
                    gpu::sgEvaluate(d, a, float(la)) * gpu::sgEvaluate(d, b, float(lb));
                CHECK(product == doctest::Approx(factors).epsilon(1e-3).scale(1e-4));
            }
}

TEST_CASE("sg: special values stay finite and in range")
{
    const vec3 z(0.0f, 0.0f, 1.0f);
    for (const float la : {0.0f, 1e-38f, 1e-20f, 1e-6f, 1.0f, 1e4f, 1e5f})
        for (const float lb : {0.0f, 1e-38f, 1e-20f, 1e-6f, 1.0f, 1e4f, 1e5f})
            for (const float x : {0.0f, 1e-20f, 1e-6f, 1.0f, -1.0f}) {
                const vec3 b = gpu::safeNormalize(vec3(x, 0.0f, -1.0f), z);
                const float inner = gpu::sgInnerProduct(z, la, b, lb);
                CHECK(std::isfinite(inner));
                CHECK(inner >= 0.0f);
                CHECK(inner <= 4.0f * gpu::kPi * 1.00001f);
                vec3 axis;
                float lambda = 0.0f;
                float logAmplitude = 0.0f;
                gpu::sgProduct(z, la, b, lb, axis, lambda, logAmplitude);
                CHECK(logAmplitude <= 0.0f);
                CHECK(glm::length(axis) == doctest::Approx(1.0).epsilon(1e-5));
            }
}

TEST_CASE("sg: normalisation of extreme vectors")
{
    const vec3 up(0.0f, 0.0f, 1.0f);
    for (const float s : {1e-38f, 1e-20f, 1.0f, 1e20f, 2e38f})
        CHECK(glm::length(gpu::safeNormalize(vec3(s, -s, 0.5f * s), up)) ==
              doctest::Approx(1.0).epsilon(1e-5));
    const float nan = std::nanf("");
    CHECK(gpu::safeNormalize(vec3(0.0f), up) == up);
    CHECK(gpu::safeNormalize(vec3(INFINITY, 0.0f, 0.0f), up) == up);
    // A NaN must not come out as a direction that looks fine, whichever component it is.
    for (const vec3 v : {vec3(nan), vec3(nan, 1.0f, 0.0f), vec3(1.0f, nan, 0.0f)})
        CHECK(std::isnan(gpu::safeNormalize(v, up).x));
}

TEST_CASE("sg: mean length and its inverse")
{
    for (double l = 1e-3; l < 2e3; l *= 1.2) {
        const float r = gpu::sgMeanLength(float(l));
        const double exact = l < 1e-2 ? l / 3.0 - l * l * l / 45.0 : 1.0 / std::tanh(l) - 1.0 / l;
        CHECK(r == doctest::Approx(exact).epsilon(2e-6));
        // Near r = 1 the rounding of r itself costs lambda * 6e-8.
        CHECK(gpu::sgSharpnessFromMeanLength(r) == doctest::Approx(l).epsilon(5e-5 + 1.5e-7 * l));
    }
}
