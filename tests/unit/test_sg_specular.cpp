// GGX reflections of spherical gaussians against quadrature in double, on the grid of roughness x
// sharpness x view.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "passes/shading_study.hpp"
#include "passes/specular_lut.hpp"

using namespace strandlight;
using glm::dvec3;
using glm::vec3;

TEST_CASE("sg specular: error over roughness x sharpness x view")
{
    double asg = 0.0;
    double ndf = 0.0;
    double mixture = 0.0;
    double dielectric = 0.0;
    int cells = 0;
    std::string table =
        "sum |approximation - reference| / sum reference for F = 1; last: mixture, f0 = 0.04\n"
        "alpha lambda |   ASG   NDF mixture f0=0.04\n";
    for (const double alpha : {0.05, 0.1, 0.2, 0.4, 0.64, 0.9})
        for (const double lambda : {1.0, 4.0, 16.0, 64.0, 256.0}) {
            const SpecularErrors totals = specularErrors(alpha, lambda);
            char line[128];
            std::snprintf(line, sizeof line, "%5.2f %6.0f | %5.3f %5.3f   %5.3f   %5.3f\n", alpha,
                          lambda, totals.asg / totals.reference, totals.ndf / totals.reference,
                          totals.mixture / totals.reference,
                          totals.dielectric / totals.dielectricReference);
            table += line;
            asg += totals.asg / totals.reference;
            ndf += totals.ndf / totals.reference;
            mixture += totals.mixture / totals.reference;
            dielectric += totals.dielectric / totals.dielectricReference;
            ++cells;
        }
    MESSAGE(table << "mean: ASG " << asg / cells << ", NDF filter " << ndf / cells << ", mixture "
                  << mixture / cells << "; f0 = 0.04: " << dielectric / cells);
    CHECK(mixture <= 0.5 * asg); // what the issue asks
    CHECK(mixture / cells <=
          0.06); // what the method reaches, with room for another compiler's rounding
    CHECK(dielectric / cells <= 0.12);
    CHECK(ndf < asg);
}

TEST_CASE("sg specular: table cells are not special")
{
    // Roughness and views between table cells, where bad lobe identities would show.
    double worst = 0.0;
    for (const double alpha : {0.023, 0.033, 0.07, 0.15, 0.3, 0.52, 0.8, 1.0})
        for (const double degrees : {1.4, 20.0, 44.0, 71.0, 83.0, 87.0}) {
            const SpecularErrors totals =
                specularErrors(alpha, std::cos(degrees * M_PI / 180.0), 16.0, 40);
            CAPTURE(alpha);
            CAPTURE(degrees);
            CHECK(totals.mixture / totals.reference < 0.2);
            worst = std::max(worst, totals.mixture / totals.reference);
        }
    MESSAGE("worst mixture error between cells at lambda 16: " << worst);
}

TEST_CASE("sg specular: a constant environment returns the directional albedo")
{
    const vec3 normal(0.0f, 0.0f, 1.0f);
    for (const float alpha : {0.03f, 0.1f, 0.35f, 0.8f})
        for (const float degrees : {5.0f, 40.0f, 75.0f}) {
            const float cosView = std::cos(glm::radians(degrees));
            const vec3 view(std::sin(glm::radians(degrees)), 0.0f, cosView);
            const gpu::SgMixture mixture = specularTable().mixture(alpha, normal, view);
            const GgxQuadrature reference{double(alpha), double(cosView)};
            const double albedo = reference.reflect(dvec3(0.0, 0.0, 1.0), 0.0);
            const double dielectric = reference.reflect(dvec3(0.0, 0.0, 1.0), 0.0, 0.04);
            const glm::vec2 white = gpu::sgSpecularMixture(mixture, normal, view, normal, 0.0f);
            CHECK(white.x + white.y == doctest::Approx(albedo).epsilon(0.02));
            CHECK(mixture.scale * 0.04 + mixture.bias == doctest::Approx(dielectric).epsilon(0.04));
        }
}

TEST_CASE("sg specular: what Fresnel takes from diffuse light")
{
    constexpr int kSide = 64;
    for (const double cosView : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        const dvec3 view(std::sqrt(1.0 - cosView * cosView), 0.0, cosView);
        double sum = 0.0;
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                const double r = std::sqrt((i + 0.5) / kSide);
                const double phi = M_PI * (j + 0.5) / kSide;
                const dvec3 light(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - r * r));
                sum += std::pow(1.0 - glm::dot(view, glm::normalize(view + light)), 5.0);
            }
        // 1e-4 of the light: far below what a picture shows.
        CHECK(std::abs(gpu::diffuseSchlickWeight(float(cosView)) - sum / (kSide * kSide)) < 1e-4);
    }
}

TEST_CASE("sg specular: stress values are finite and not negative")
{
    const vec3 normal(0.0f, 0.0f, 1.0f);
    for (const float alpha : {0.0f, 1e-6f, 1e-3f, 0.5f, 1.0f})
        for (const float cosView : {0.0f, 1e-6f, 1e-3f, 0.5f, 1.0f}) {
            const vec3 view(std::sqrt(1.0f - cosView * cosView), 0.0f, cosView);
            const gpu::SgMixture mixture = specularTable().mixture(alpha, normal, view);
            for (const float lambda : {0.0f, 1e-6f, 1.0f, 1e3f, 1e5f})
                for (const vec3 axis : {normal, -normal, vec3(1.0f, 0.0f, 0.0f), -view, view}) {
                    CAPTURE(alpha);
                    CAPTURE(cosView);
                    CAPTURE(lambda);
                    const glm::vec2 reflected =
                        gpu::sgSpecularMixture(mixture, normal, view, axis, lambda);
                    for (const float value :
                         {gpu::sgSpecularAsg(alpha, normal, view, axis, lambda),
                          gpu::sgSpecularNdfFilter(alpha, normal, view, axis, lambda), reflected.x,
                          reflected.y}) {
                        CHECK(std::isfinite(value));
                        CHECK(value >= 0.0f);
                    }
                    // A unit lobe cannot reflect more than a white surround; 5 % for the fit.
                    CHECK(reflected.x + reflected.y <= 1.05f);
                }
        }
}
