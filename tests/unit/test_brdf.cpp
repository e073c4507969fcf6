// The surface model: reciprocity, energy, Lambert limit, and samples against the density.
#include <doctest/doctest.h>

#include <random>
#include <vector>

#include "shaders/shared/brdf.h"

using namespace strandlight;

namespace {

glm::vec3 direction(float theta, float phi)
{
    return glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                     std::cos(theta));
}

gpu::Surface plastic(float roughness)
{
    return gpu::makeSurface(glm::vec3(0.6f, 0.5f, 0.4f), 0.0f, roughness, 1.0f, glm::vec3(1.0f));
}

gpu::Surface metal(float roughness)
{
    return gpu::makeSurface(glm::vec3(1.0f), 1.0f, roughness, 1.0f, glm::vec3(1.0f));
}

// E[value / pdf] over samples of the BRDF: the directional albedo.
glm::dvec3 albedo(const gpu::Surface& surface, glm::vec3 v, int count)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < count; ++i) {
        const glm::vec3 l =
            gpu::sampleBrdf(surface, v, glm::vec3(unit(random), unit(random), unit(random)));
        const gpu::BrdfValue f = gpu::evaluateBrdf(surface, v, l);
        if (f.pdf > gpu::kSmallestPdf)
            sum += glm::dvec3(f.value) / double(f.pdf);
    }
    return sum / double(count);
}

// The same by the midpoint rule over the hemisphere, in double.
glm::dvec3 albedoByQuadrature(const gpu::Surface& surface, glm::vec3 v, int n)
{
    glm::dvec3 sum(0.0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double z = (i + 0.5) / n;
            const double phi = 6.283185307179586 * (j + 0.5) / (2 * n);
            const double s = std::sqrt(1.0 - z * z);
            const glm::vec3 l(float(s * std::cos(phi)), float(s * std::sin(phi)), float(z));
            sum += glm::dvec3(gpu::evaluateBrdf(surface, v, l).value);
        }
    return sum * (6.283185307179586 / (double(n) * 2.0 * n));
}

} // namespace

TEST_CASE("brdf: specular factor 0 is exactly Lambert")
{
    const gpu::Surface surface =
        gpu::makeSurface(glm::vec3(0.6f, 0.5f, 0.4f), 0.0f, 0.3f, 0.0f, glm::vec3(1.0f));
    CHECK(gpu::layerProbability(surface, direction(0.5f, 1.0f)) == 0.0f);
    for (const float theta : {0.0f, 0.4f, 1.2f, 1.55f}) {
        const glm::vec3 l = direction(theta, 2.0f);
        const gpu::BrdfValue f = gpu::evaluateBrdf(surface, direction(0.7f, 0.3f), l);
        CHECK(f.value == surface.diffuse * (l.z * gpu::kInversePi));
        CHECK(f.pdf == l.z * gpu::kInversePi);
    }
}

TEST_CASE("brdf: reciprocal")
{
    for (const float roughness : {0.1f, 0.4f, 1.0f})
        for (const gpu::Surface& surface : {plastic(roughness), metal(roughness)})
            for (const float a : {0.1f, 0.8f, 1.4f})
                for (const float b : {0.2f, 0.9f, 1.5f}) {
                    const glm::vec3 v = direction(a, 0.3f);
                    const glm::vec3 l = direction(b, 2.9f);
                    const glm::vec3 there = gpu::evaluateBrdf(surface, v, l).value * v.z;
                    const glm::vec3 back = gpu::evaluateBrdf(surface, l, v).value * l.z;
                    for (int k = 0; k < 3; ++k)
                        REQUIRE(there[k] == doctest::Approx(back[k]).epsilon(1e-4));
                }
}

TEST_CASE("brdf: the layer alone keeps energy; it loses what single scattering must lose")
{
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f})
        for (const float theta : {0.05f, 0.7f, 1.2f, 1.5f}) {
            const glm::dvec3 e = albedo(metal(roughness), direction(theta, 0.4f), 20000);
            CAPTURE(roughness);
            CAPTURE(theta);
            // sd of the estimate is below 0.5 / sqrt(20000) = 0.0035; 4 of them.
            CHECK(e.x <= 1.0 + 0.014);
            CHECK(e.x >= 0.3);
        }
    // A mirror-like metal loses nothing.
    CHECK(albedo(metal(0.0f), direction(0.7f, 0.4f), 20000).x ==
          doctest::Approx(1.0).epsilon(0.002));
}

TEST_CASE("brdf: with its diffuse part it stays below 1.01 away from grazing angles")
{
    const gpu::Surface white = gpu::makeSurface(glm::vec3(1.0f), 0.0f, 0.5f, 1.0f, glm::vec3(1.0f));
    for (const float theta : {0.0f, 0.3f, 0.6f, 0.9f})
        CHECK(albedoByQuadrature(white, direction(theta, 0.4f), 200).x <= 1.01);
}

TEST_CASE("brdf: sampled and integrated albedo agree")
{
    for (const float roughness : {0.25f, 0.5f, 1.0f})
        for (const gpu::Surface& surface : {plastic(roughness), metal(roughness)})
            for (const float theta : {0.1f, 0.9f, 1.4f}) {
                const glm::vec3 v = direction(theta, 1.1f);
                const double sampled = albedo(surface, v, 100000).x;
                const double integrated = albedoByQuadrature(surface, v, 600).x;
                CAPTURE(roughness);
                CAPTURE(theta);
                // sd of value/pdf is below 1: 4 / sqrt(1e5) = 0.0126.
                CHECK(std::abs(sampled - integrated) < 0.0126);
            }
}

TEST_CASE("brdf: samples follow the density (chi-square)")
{
    // Cells uniform in (z, phi); expected counts by 16 x 16 midpoints per cell.
    constexpr int kZ = 16;
    constexpr int kPhi = 16;
    constexpr int kCount = 200000;
    for (const float roughness : {0.4f, 0.8f})
        for (const gpu::Surface& surface : {plastic(roughness), metal(roughness)}) {
            const glm::vec3 v = direction(0.9f, 0.7f);
            std::vector<double> counts(kZ * kPhi + 1), expected(kZ * kPhi + 1);
            std::mt19937 random(5);
            std::uniform_real_distribution<float> unit(0.0f, 1.0f);
            for (int i = 0; i < kCount; ++i) {
                const glm::vec3 l = gpu::sampleBrdf(
                    surface, v, glm::vec3(unit(random), unit(random), unit(random)));
                const float turn = std::atan2(l.y, l.x) / 6.2831853f + 0.5f;
                const int cell =
                    std::min(int(l.z * kZ), kZ - 1) * kPhi + std::min(int(turn * kPhi), kPhi - 1);
                counts[std::size_t(l.z <= 0.0f ? kZ * kPhi : cell)] += 1.0;
            }
            double total = 0.0;
            for (int z = 0; z < kZ * 16; ++z)
                for (int p = 0; p < kPhi * 16; ++p) {
                    const float height = (float(z) + 0.5f) / (kZ * 16);
                    const float phi = ((float(p) + 0.5f) / (kPhi * 16) - 0.5f) * 6.2831853f;
                    const float s = std::sqrt(1.0f - height * height);
                    const glm::vec3 l(s * std::cos(phi), s * std::sin(phi), height);
                    const double mass = double(gpu::evaluateBrdf(surface, v, l).pdf) *
                                        6.283185307179586 / (kZ * 16.0 * kPhi * 16.0);
                    expected[std::size_t(z / 16 * kPhi + p / 16)] += mass * kCount;
                    total += mass;
                }
            REQUIRE(total <= 1.001);
            expected[kZ * kPhi] = std::max(1.0 - total, 0.0) * kCount; // below the horizon
            double chi = 0.0;
            int degrees = -1;
            double restCount = 0.0, restExpected = 0.0;
            for (std::size_t i = 0; i < counts.size(); ++i)
                if (expected[i] >= 50.0) {
                    chi += std::pow(counts[i] - expected[i], 2.0) / expected[i];
                    ++degrees;
                } else {
                    restCount += counts[i];
                    restExpected += expected[i];
                }
            if (restExpected > 10.0) {
                chi += std::pow(restCount - restExpected, 2.0) / restExpected;
                ++degrees;
            }
            CAPTURE(roughness);
            CAPTURE(chi);
            CAPTURE(degrees);
            // Normal approximation of chi-square: 5 sd, and 1 % for the midpoint rule's own error.
            CHECK(chi < degrees * 1.01 + 5.0 * std::sqrt(2.0 * degrees));
        }
}
