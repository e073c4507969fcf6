// Hemisphere integrals of spherical gaussians against quadrature in double.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

#include "passes/shading_study.hpp"
#include "shaders/shared/sg_diffuse.h"

namespace gpu = strandlight::gpu;

TEST_CASE("sg diffuse: error functions")
{
    double worst = 0.0;
    double worstTail = 0.0;
    for (double x = -10.0; x <= 10.0; x += 1e-3) {
        const float xf = float(x);
        worst = std::max(worst, std::abs(gpu::errorFunction(xf) - std::erf(double(xf))));
        if (x > 0.0 && x < 8.0)
            worstTail =
                std::max(worstTail,
                         std::abs(gpu::errorFunctionComplement(xf) / std::erfc(double(xf)) - 1.0));
    }
    CHECK(worst < 3e-7);
    // exp(-x^2) with x^2 rounded to fp32 costs x^2 * 6e-8.
    CHECK(worstTail < 8e-6);
    CHECK(gpu::errorFunctionComplement(100.0f) == 0.0f);
}

TEST_CASE("sg diffuse: irradiance against quadrature for every sharpness")
{
    double worst = 0.0;
    double hillFromOne = 0.0;
    double wang = 0.0;
    double hemisphere = 0.0;
    for (const double lambda :
         {1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 128.0, 512.0, 2048.0, 1e4, 1e5}) {
        const strandlight::DiffuseErrors e = strandlight::diffuseErrors(lambda);
        MESSAGE("lambda " << lambda << ": Tokuyoshi 2024 " << e.tokuyoshi << ", Hill " << e.hill
                          << ", Wang " << e.wang << ", hemisphere " << e.hemisphere);
        worst = std::max(worst, e.tokuyoshi);
        wang = std::max(wang, e.wang);
        hemisphere = std::max(hemisphere, e.hemisphere);
        if (lambda >= 1.0)
            hillFromOne = std::max(hillFromOne, e.hill);
    }
    CHECK(worst <= 2e-3);       // the shipped form
    CHECK(hillFromOne <= 3e-2); // the alternatives are what their comments say
    CHECK(wang <= 0.2);
    CHECK(hemisphere <= 1e-2);
}

TEST_CASE("sg diffuse: continuous at the switches and monotone in the cosine")
{
    for (const float at : {1e-4f, 0.25f, 0.5f, 1.0f}) {
        for (const float c : {-1.0f, -0.3f, 0.0f, 0.4f, 1.0f}) {
            const float below = gpu::sgIrradiance(std::nextafter(at, 0.0f), c);
            const float above = gpu::sgIrradiance(std::nextafter(at, 2.0f), c);
            CHECK(std::abs(above - below) < 4e-6f * gpu::sgIntegral(at));
            const float hemisphereBelow = gpu::sgHemisphereIntegral(std::nextafter(at, 0.0f), c);
            const float hemisphereAbove = gpu::sgHemisphereIntegral(std::nextafter(at, 2.0f), c);
            CHECK(std::abs(hemisphereAbove - hemisphereBelow) < 4e-6f * gpu::sgIntegral(at));
        }
    }
    for (const float lambda : {0.1f, 3.0f, 50.0f, 3000.0f}) {
        float last = -1.0f;
        for (int i = 0; i <= 200; ++i) {
            const float value = gpu::sgIrradiance(lambda, -1.0f + 0.01f * float(i));
            CHECK(value >= last - 2e-6f);
            last = value;
        }
    }
}

TEST_CASE("sg diffuse: special values stay finite and within the lobe's energy")
{
    for (const float lambda :
         {0.0f, 1e-38f, 1e-20f, 1e-8f, 1e-6f, 1.0f, 88.0f, 104.0f, 1e4f, 1e5f, 1e6f})
        for (const float c :
             {-1.0f, -1.0f + 6e-8f, -1e-20f, 0.0f, 1e-20f, 0.5f, 1.0f - 6e-8f, 1.0f}) {
            const float energy = gpu::sgIntegral(lambda);
            for (const float value :
                 {gpu::sgIrradiance(lambda, c), gpu::sgHemisphereIntegral(lambda, c)}) {
                CAPTURE(lambda);
                CAPTURE(c);
                CHECK(std::isfinite(value));
                CHECK(value >= 0.0f);
                CHECK(value <= energy * 1.00001f);
            }
            const float fraction = gpu::sgHemisphereFraction(lambda, c);
            CHECK((fraction >= 0.0f && fraction <= 1.0f));
        }
    CHECK(gpu::sgIrradiance(0.0f, 0.3f) == doctest::Approx(gpu::kPi).epsilon(1e-6));
    CHECK(gpu::sgIrradiance(1e5f, 0.5f) == doctest::Approx(0.5 * 2.0 * M_PI / 1e5).epsilon(1e-4));
}
