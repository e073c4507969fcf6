#include "passes/hair_distant.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.hpp"
#include "engine/scene/environment.hpp"
#include "passes/sg_fit_reference.hpp"
#include "shaders/shared/octahedral.h"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"

namespace strandlight {
namespace {

constexpr std::uint32_t kSide = 32;       // of the octahedral image that is fitted
constexpr std::uint32_t kFineWidth = 256; // of the lat-long grid it is averaged from, at least
constexpr std::uint32_t kSteps = 600;
constexpr float kMappedSharpness = 6.0f; // wider lobes reach 45 degrees and more
constexpr float kMappedShare = 0.1f;     // of all energy
constexpr std::uint32_t kMostMapped = 2; // a map costs as much as drawing the hair

// Mean radiance and steradians of each cell of the whole sphere.
struct SphereImage
{
    std::vector<glm::dvec3> radiance = std::vector<glm::dvec3>(kSide * kSide, glm::dvec3(0.0));
    std::vector<double> steradians = std::vector<double>(kSide * kSide, 0.0);
};

SphereImage averageSphere(const Environment& environment)
{
    const CpuImage& source = environment.latLong;
    const std::uint32_t split = (kFineWidth + source.width - 1) / source.width;
    const std::uint32_t width = source.width * split, height = source.height * split;
    SphereImage image;
    for (std::uint32_t y = 0; y < height; ++y) {
        const double top = M_PI * double(y) / height, bottom = M_PI * double(y + 1) / height;
        const double steradians = (std::cos(top) - std::cos(bottom)) * 2.0 * M_PI / width;
        for (std::uint32_t x = 0; x < width; ++x) {
            const glm::vec3 direction = gpu::environmentDirection(
                (float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height));
            const glm::vec2 uv = gpu::octEncode(direction) * float(kSide);
            const std::uint32_t cell = std::min(std::uint32_t(uv.y), kSide - 1) * kSide +
                                       std::min(std::uint32_t(uv.x), kSide - 1);
            image.radiance[cell] +=
                steradians * glm::dvec3(environmentRadiance(environment, direction));
            image.steradians[cell] += steradians;
        }
    }
    for (std::size_t cell = 0; cell < image.radiance.size(); ++cell)
        if (image.steradians[cell] > 0.0)
            image.radiance[cell] /= image.steradians[cell];
    return image;
}

// One texel that sees the whole sphere, less what is the same everywhere.
FitProblem sphereProblem(const SphereImage& image, glm::dvec3 darkest, std::uint32_t lobes)
{
    FitProblem problem;
    problem.cells.texelCount = problem.cells.cellCount = 1;
    problem.cells.corners.assign(4, 0);
    problem.cells.gather = {0, 1, 2, 3};
    problem.cells.neighbours.assign(4, gpu::kSgFitNone);
    problem.lobes = lobes;
    problem.size = kSide;
    problem.minimumLogSharpness = -1.0f;
    problem.maximumLogSharpness = std::log(float(kSide * kSide));
    double mean = 0.0;
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
        const glm::vec2 uv((float(cell % kSide) + 0.5f) / kSide,
                           (float(cell / kSide) + 0.5f) / kSide);
        const double share = image.steradians[cell] / (4.0 * M_PI);
        problem.directions.emplace_back(gpu::octDecode(uv), float(share));
        const glm::vec3 more(glm::max(image.radiance[cell] - darkest, 0.0));
        problem.images.push_back(gpu::packRgb9e5(more));
        mean += share * double(more.x + more.y + more.z) / 3.0;
    }
    problem.scales = {float(mean)};
    return problem;
}

// Evenly over the sphere on a golden-angle spiral.
SgField sphereStart(std::uint32_t count, float mean)
{
    SgField field;
    field.lobeCount = count;
    for (std::uint32_t k = 0; k < count; ++k) {
        const float z = 1.0f - 2.0f * (float(k) + 0.5f) / float(count);
        const float azimuth = float(k) * 2.39996323f, radius = std::sqrt(1.0f - z * z);
        field.lobes.push_back({{radius * std::cos(azimuth), z, radius * std::sin(azimuth)},
                               std::log(float(count)),
                               glm::vec3(0.5f * mean)});
    }
    return field;
}

float luminance(glm::vec3 c)
{
    return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

gpu::HairLobe hairLobe(const SgLobe& lobe, glm::dvec3 factor)
{
    gpu::HairLobe result{};
    result.axis = glm::normalize(lobe.axis);
    result.sharpness = std::exp(lobe.logSharpness);
    result.energy = glm::vec3(factor) * lobe.amplitude * gpu::sgIntegral(result.sharpness);
    return result;
}

// Brightest first, shares of all, and which of them are worth a shadow map.
void order(HairDistantLight& light)
{
    std::sort(light.lobes.begin(), light.lobes.end() - 1,
              [](const gpu::HairLobe& a, const gpu::HairLobe& b) {
                  const bool sharpA = a.sharpness >= kMappedSharpness;
                  const bool sharpB = b.sharpness >= kMappedSharpness;
                  return sharpA != sharpB ? sharpA : luminance(a.energy) > luminance(b.energy);
              });
    float all = 0.0f;
    for (const gpu::HairLobe& lobe : light.lobes)
        all += luminance(lobe.energy);
    for (gpu::HairLobe& lobe : light.lobes) {
        lobe.share = all > 0.0f ? luminance(lobe.energy) / all : 0.0f;
        if (&lobe == &light.lobes[light.mapped] && light.mapped < kMostMapped &&
            lobe.sharpness >= kMappedSharpness && lobe.share >= kMappedShare)
            ++light.mapped;
    }
}

} // namespace

HairDistantLight fitDistantLight(const Environment& environment, std::uint32_t count)
{
    if (count < 1 || count > 16)
        throw Error("hair: " + std::to_string(count) + " distant lobes; 1 to 16 are possible");
    const SphereImage image = averageSphere(environment);
    glm::dvec3 darkest(1e30), residual(0.0);
    for (const glm::dvec3& radiance : image.radiance)
        darkest = glm::min(darkest, radiance);
    for (std::size_t cell = 0; cell < image.radiance.size(); ++cell)
        residual += image.steradians[cell] * (image.radiance[cell] - darkest);

    HairDistantLight light;
    const FitProblem problem = sphereProblem(image, darkest, count);
    // Below rounding the light is even.
    if (residual.x + residual.y + residual.z >
        1e-5 * 4.0 * M_PI * (darkest.x + darkest.y + darkest.z)) {
        FitSettings settings;
        settings.lobes = count;
        settings.steps = kSteps;
        settings.directionsPerStep = 256;
        settings.cornerFraction = 1.0f;
        const SgField field = fitLobesReference(
            problem, startFit(problem, sphereStart(count, problem.scales[0])), settings);
        glm::dvec3 sum(0.0);
        for (const SgLobe& lobe : field.lobes)
            sum += glm::dvec3(hairLobe(lobe, glm::dvec3(1.0)).energy);
        const glm::dvec3 factor = residual / glm::max(sum, 1e-30);
        for (const SgLobe& lobe : field.lobes)
            if (luminance(lobe.amplitude) > 0.0f)
                light.lobes.push_back(hairLobe(lobe, factor));
    }
    gpu::HairLobe constant{};
    constant.axis = {0.0f, 1.0f, 0.0f};
    constant.energy = glm::vec3(darkest * 4.0 * M_PI);
    light.lobes.push_back(constant);
    order(light);
    return light;
}

} // namespace strandlight
