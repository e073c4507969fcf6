// Energy of the fibre's lobes in a white furnace, and their values at hard angles.
#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

#include "shaders/shared/hair_bsdf.h"

using namespace strandlight;

namespace {

const glm::vec3 kTangent(1.0f, 0.0f, 0.0f);

// Unit direction at an angle from the normal plane and an azimuth about the fibre.
glm::vec3 direction(double theta, double phi)
{
    return glm::vec3(float(std::sin(theta)), float(std::cos(theta) * std::cos(phi)),
                     float(std::cos(theta) * std::sin(phi)));
}

// Radiance of a fibre under radiance 1 from everywhere: the integral of hairScatter over the
// sphere. Midpoint rule with 500 x 64 points: the narrowest lobe (standard deviation 0.04 rad)
// spans six of them.
glm::dvec3 furnace(double thetaView, float roughness, float tilt, glm::vec3 color)
{
    constexpr int kThetas = 500, kPhis = 64;
    const glm::vec3 view = direction(thetaView, 0.0);
    glm::dvec3 sum(0.0);
    for (int t = 0; t < kThetas; ++t) {
        const double theta = M_PI * ((t + 0.5) / kThetas - 0.5);
        glm::dvec3 ring(0.0);
        for (int p = 0; p < kPhis; ++p) {
            const glm::vec3 light = direction(theta, 2.0 * M_PI * (p + 0.5) / kPhis);
            ring += glm::dvec3(gpu::hairScatter(kTangent, light, view, color, roughness, tilt));
        }
        sum += ring * (std::cos(theta) * M_PI / kThetas * 2.0 * M_PI / kPhis);
    }
    return sum;
}

} // namespace

TEST_CASE("hair fibre in a white furnace: no absorption, no loss")
{
    for (const float roughness : {0.1f, 0.2f, 0.3f, 0.5f, 0.7f, 1.0f})
        for (const double degrees : {0.0, 20.0, -45.0, 60.0, -75.0, 85.0})
            for (const float tilt : {0.0f, 0.035f}) {
                CAPTURE(roughness);
                CAPTURE(degrees);
                CAPTURE(tilt);
                const glm::dvec3 energy =
                    furnace(degrees * M_PI / 180.0, roughness, tilt, glm::vec3(1.0f));
                // 0.5 % for fp32 exponents and the midpoint rule; the lobes share out exactly 1.
                CHECK(energy.x <= 1.005);
                CHECK(energy.x >= 0.9);
            }
}

TEST_CASE("hair fibre in a white furnace: absorption takes energy, colour by colour")
{
    for (const float roughness : {0.15f, 0.4f, 0.9f})
        for (const double degrees : {0.0, 40.0, -70.0}) {
            const glm::dvec3 energy =
                furnace(degrees * M_PI / 180.0, roughness, 0.035f, glm::vec3(0.8f, 0.4f, 0.05f));
            CAPTURE(roughness);
            CAPTURE(degrees);
            CHECK(energy.x < 1.0);
            CHECK(energy.y < energy.x);
            CHECK(energy.z < energy.y);
            CHECK(energy.z > 0.03); // the surface reflects whatever the pigment
        }
}

TEST_CASE("hair fibre: finite and not negative at every corner of its domain")
{
    const double angles[] = {-M_PI / 2, -M_PI / 2 + 1e-4, -1.0, 0.0, 1e-4, 1.2, M_PI / 2};
    const double phis[] = {0.0, 1e-4, 1.0, M_PI - 1e-4, M_PI};
    for (const double i : angles)
        for (const double o : angles)
            for (const double phi : phis)
                for (const float roughness : {0.0f, 0.05f, 0.5f, 1.0f})
                    for (const float color : {0.0f, 0.5f, 1.0f}) {
                        const glm::vec3 s =
                            gpu::hairScatter(kTangent, direction(i, 0.0), direction(o, phi),
                                             glm::vec3(color), roughness, 0.035f);
                        const glm::vec3 m = gpu::hairMultipleScatter(
                            kTangent, direction(i, 0.0), direction(o, phi), glm::vec3(color), 0.3f);
                        CHECK(std::isfinite(s.x));
                        CHECK(s.x >= 0.0f);
                        CHECK(std::isfinite(m.x));
                        CHECK(m.x >= 0.0f);
                    }
}

TEST_CASE("log I0 exp(-x) against its series")
{
    for (const double x : {0.0, 0.5, 2.0, 3.7, 3.8, 10.0, 30.0}) {
        double term = 1.0, sum = 1.0;
        for (int k = 1; k < 200; ++k) {
            term *= (x * x / 4.0) / (double(k) * k);
            sum += term;
        }
        // The handbook's fit has 2e-7 relative error of I0; fp32 logarithms add some 1e-6.
        CHECK(std::abs(double(gpu::hairLogBesselI0(float(x))) - (std::log(sum) - x)) <=
              5e-6 * (1.0 + std::log(sum)));
    }
}
