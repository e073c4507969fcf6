// The fibre under a distant gaussian: against hairScatter integrated over the lobe, at both ends of
// its sharpness, and energy; and lobes fitted to environments and light fields.
#include <cmath>
#include <initializer_list>

#include <doctest/doctest.h>

#include "engine/scene/atlas.hpp"
#include "engine/scene/procedural.hpp"
#include "passes/hair_distant.hpp"
#include "shaders/shared/environment.h"
#include "shaders/shared/hair_lobe.h"

using namespace strandlight;

namespace {

const glm::vec3 kTangent(1.0f, 0.0f, 0.0f);
const glm::vec3 kBrown(0.5f, 0.3f, 0.15f);
const float kTilt = glm::radians(2.0f);

// Unit direction at an angle from the normal plane and an azimuth about the fibre.
glm::vec3 direction(double theta, double phi)
{
    return glm::vec3(float(std::sin(theta)), float(std::cos(theta) * std::cos(phi)),
                     float(std::cos(theta) * std::sin(phi)));
}

// hairScatter's mean over the SG by the midpoint rule: points 0.02 rad apart, where the narrowest
// factor has a standard deviation of 0.06.
glm::dvec3 quadrature(glm::vec3 axis, float sharpness, glm::vec3 view, float roughness)
{
    constexpr int kThetas = 160, kPhis = 160;
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (int t = 0; t < kThetas; ++t) {
        const double theta = M_PI * ((t + 0.5) / kThetas - 0.5);
        for (int p = 0; p < kPhis; ++p) {
            const glm::vec3 light = direction(theta, 2.0 * M_PI * (p + 0.5) / kPhis);
            const double weight = std::cos(theta) * double(gpu::sgEvaluate(light, axis, sharpness));
            weights += weight;
            if (weight > 1e-7)
                sum += weight * glm::dvec3(gpu::hairScatter(kTangent, light, view, kBrown,
                                                            roughness, kTilt));
        }
    }
    return sum / weights;
}

Environment constantEnvironment(glm::vec3 radiance)
{
    return {CpuImage(64, 32, glm::vec4(radiance, 1.0f))};
}

// White hair's radiance under all lobes, nothing in the way.
glm::vec3 whiteRadiance(const HairDistantLight& light, glm::vec3 tangent, glm::vec3 view)
{
    glm::vec3 sum(0.0f);
    for (const gpu::HairLobe& lobe : light.lobes)
        sum += lobe.energy * gpu::hairScatterLobe(tangent, lobe.axis, lobe.sharpness, view,
                                                  glm::vec3(1.0f), 0.3f, kTilt);
    return sum;
}

glm::vec3 energyOf(const HairDistantLight& light)
{
    glm::vec3 sum(0.0f);
    for (const gpu::HairLobe& lobe : light.lobes)
        sum += lobe.energy;
    return sum;
}

} // namespace

TEST_CASE("hair under a lobe is the fibre's mean over it")
{
    for (const float roughness : {0.2f, 0.5f})
        for (const float sharpness : {0.5f, 4.0f, 16.0f, 64.0f, 256.0f}) {
            double error = 0.0, pointError = 0.0, sum = 0.0;
            for (const double in : {-0.8, 0.1, 0.6})
                for (const double out : {-0.7, 0.3, 1.0})
                    for (const double phi : {0.0, 1.2, 2.4, 3.1}) {
                        const glm::vec3 axis = direction(in, 0.0), view = direction(out, phi);
                        const double truth = quadrature(axis, sharpness, view, roughness).x;
                        error +=
                            std::abs(double(gpu::hairScatterLobe(kTangent, axis, sharpness, view,
                                                                 kBrown, roughness, kTilt)
                                                .x) -
                                     truth);
                        pointError += std::abs(
                            double(gpu::hairScatter(kTangent, axis, view, kBrown, roughness, kTilt)
                                       .x) -
                            truth);
                        sum += truth;
                    }
            CAPTURE(roughness);
            CAPTURE(sharpness);
            CAPTURE(pointError / sum); // were the light a point: up to 2.7
            // The azimuth's densities and the two marginals are joined as if independent: 4 %.
            CHECK(error / sum <= 0.05);
        }
}

TEST_CASE("hair under the sharpest lobe is hair under a directional light")
{
    for (const double in : {-0.8, 0.0, 0.6})
        for (const double out : {-0.7, 0.3, 1.2})
            for (const double phi : {0.0, 0.7, 2.0, 3.1}) {
                const glm::vec3 axis = direction(in, 0.0), view = direction(out, phi);
                const glm::vec3 lobe = gpu::hairScatterLobe(kTangent, axis, gpu::kSgMaxSharpness,
                                                            view, kBrown, 0.3f, kTilt);
                const glm::vec3 point = gpu::hairScatter(kTangent, axis, view, kBrown, 0.3f, kTilt);
                for (int c = 0; c < 3; ++c) // its own width: 1e-5 on a variance of 0.02
                    CHECK(std::abs(lobe[c] - point[c]) <= 2e-3f * point[c] + 1e-5f);
            }
}

TEST_CASE("white hair in even light shows that light, and blocked hair does not lose any")
{
    const glm::vec3 radiance(0.25f, 1.0f, 3.0f);
    const HairDistantLight light = fitDistantLight(constantEnvironment(radiance));
    CHECK(light.lobes.size() == 1);
    CHECK(light.mapped == 0);
    for (const double out : {-1.3, -0.4, 0.0, 0.9})
        for (int c = 0; c < 3; ++c) {
            const float shown =
                whiteRadiance(light, kTangent, direction(out, 0.3))[c] / radiance[c];
            CHECK(shown >= 0.9f);
            CHECK(shown <= 1.005f);
        }
    for (const float visible : {0.02f, 0.3f, 1.0f}) {
        const float all =
            visible + 4.0f * 3.14159265f * gpu::hairScatterOn(glm::vec3(1.0f), visible).x;
        CHECK(all == doctest::Approx(1.0).epsilon(1e-4));
        CHECK(gpu::hairScatterOn(glm::vec3(0.3f), visible).x <=
              0.3f * gpu::hairScatterOn(glm::vec3(1.0f), visible).x + 1e-9f);
    }
}

TEST_CASE("lobes of an environment keep its energy and find its lamp")
{
    Environment environment = constantEnvironment(glm::vec3(0.2f, 0.3f, 0.5f));
    const glm::vec3 lamp = glm::normalize(glm::vec3(0.5f, 0.6f, -0.4f));
    glm::dvec3 energy(0.0), lampEnergy(0.0);
    CpuImage& picture = environment.latLong;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const float v = (float(y) + 0.5f) / float(picture.height);
            const glm::vec3 d =
                gpu::environmentDirection((float(x) + 0.5f) / float(picture.width), v);
            const glm::vec3 more(glm::vec3(20.0f, 15.0f, 10.0f) * gpu::sgEvaluate(d, lamp, 40.0f));
            picture.at(x, y) += glm::vec4(more, 0.0f);
            const double steradians =
                std::sin(M_PI * double(v)) * M_PI / picture.height * 2.0 * M_PI / picture.width;
            energy += steradians * glm::dvec3(glm::vec3(picture.at(x, y)));
            lampEnergy += steradians * glm::dvec3(more);
        }
    const HairDistantLight light = fitDistantLight(environment);
    const glm::vec3 fitted = energyOf(light);
    for (int c = 0; c < 3; ++c) // RGB9E5 holds 9 bits, cells are averages of bilinear samples
        CHECK(double(fitted[c]) == doctest::Approx(energy[c]).epsilon(0.01));
    CHECK(light.mapped >= 1);
    CHECK(glm::dot(light.lobes[0].axis, lamp) > std::cos(glm::radians(3.0f)));
    double about = 0.0; // lobes may share the lamp
    for (const gpu::HairLobe& lobe : light.lobes)
        about += glm::dot(lobe.axis, lamp) > std::cos(glm::radians(15.0f)) ? lobe.energy.x : 0.0f;
    CHECK(about == doctest::Approx(lampEnergy.x).epsilon(0.1));
    CHECK(light.lobes.back().sharpness == 0.0f);
}

TEST_CASE("the light field of an even bake is even where hair is")
{
    const Scene scene = buildFurnaceScene(0.5f);
    SgBake bake;
    bake.atlas = buildAtlas(scene, {.resolution = 48});
    bake.radiance.lobeCount = 1;
    bake.radiance.lobes.assign(bake.atlas.texels.size(),
                               {{0.0f, 0.0f, 1.0f}, std::log(1e-4f), glm::vec3(2.0f, 1.0f, 0.5f)});
    for (const glm::vec3 place : {glm::vec3(0.0f), glm::vec3(0.7f, -0.5f, 0.2f)}) {
        const Environment light = lightFieldAt(scene, bake, place);
        for (const glm::vec4& pixel : light.latLong.pixels) {
            REQUIRE(pixel.x == doctest::Approx(2.0).epsilon(1e-3));
            REQUIRE(pixel.z == doctest::Approx(0.5).epsilon(1e-3));
        }
        const glm::vec3 white =
            whiteRadiance(fitDistantLight(light), kTangent, direction(0.4, 0.0));
        CHECK(white.x >= 0.9f * 2.0f);
        CHECK(white.x <= 1.005f * 2.0f);
    }
}
