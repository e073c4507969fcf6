// Hemisphere integrals of spherical gaussians against quadrature in double.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

#include "shaders/shared/sg_diffuse.h"

namespace gpu = strandlight::gpu;

namespace {

// exp(-|x|) I0(x); the azimuthal integral of an SG is 2 pi exp(..) I0(..).
double scaledBesselI0(double x)
{
    x = std::abs(x);
    if (x < 15.0)
        return std::cyl_bessel_i(0.0, x) * std::exp(-x);
    double term = 1.0;
    double sum = 1.0;
    for (int k = 1; k < 40; ++k) {
        const double ratio = (2.0 * k - 1.0) * (2.0 * k - 1.0) / (k * 8.0 * x);
        if (ratio >= 1.0)
            break;
        term *= ratio;
        sum += term;
    }
    return sum / std::sqrt(2.0 * M_PI * x);
}

// Integral over the hemisphere of the SG times cos^power, by the midpoint rule in the polar angle,
// panels gathered around the lobe's own angle so that sharp lobes are resolved.
double quadrature(double lambda, double cosine, int power)
{
    const double axis = std::acos(cosine);
    const double sine = std::sin(axis);
    const double reach = 12.0 / std::sqrt(lambda);
    const double low = std::max(0.0, axis - reach);
    const double high = std::min(M_PI / 2.0, axis + reach);
    if (low >= high)
        return 0.0;
    constexpr int kPanels = 1500;
    const double h = (high - low) / kPanels;
    double sum = 0.0;
    for (int i = 0; i < kPanels; ++i) {
        const double theta = low + h * (i + 0.5);
        const double z = std::cos(theta);
        const double r = std::sin(theta);
        const double exponent = lambda * (std::cos(theta - axis) - 1.0); // = lambda (c z + s r - 1)
        sum += (power == 1 ? z : 1.0) * r * std::exp(exponent) * scaledBesselI0(lambda * sine * r);
    }
    return 2.0 * M_PI * h * sum;
}

struct Errors
{
    double tokuyoshi = 0.0;
    double hill = 0.0;
    double wang = 0.0;
    double hemisphere = 0.0;
};

Errors worstErrors(double lambda)
{
    Errors worst;
    const double energy = -2.0 * M_PI * std::expm1(-2.0 * lambda) / lambda;
    for (int i = 0; i <= 40; ++i) {
        const double cosine = std::clamp(-1.0 + 0.05 * i, -1.0, 1.0);
        const double exact = quadrature(lambda, cosine, 1);
        const double half = quadrature(lambda, cosine, 0);
        const float l = float(lambda);
        const float c = float(cosine);
        const auto raise = [&](double& slot, float value, double reference) {
            REQUIRE(std::isfinite(value));
            slot = std::max(slot, std::abs(value - reference) / energy);
        };
        raise(worst.tokuyoshi, gpu::sgIrradiance(l, c), exact);
        raise(worst.hill, gpu::sgIrradianceHill(l, c), exact);
        raise(worst.wang, gpu::sgIrradianceWang(l, c), exact);
        raise(worst.hemisphere, gpu::sgHemisphereIntegral(l, c), half);
    }
    return worst;
}

} // namespace

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
        const Errors e = worstErrors(lambda);
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
