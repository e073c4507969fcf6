#include "passes/light_field_baselines.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "engine/base/error.hpp"
#include "passes/least_squares.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"

namespace strandlight {
namespace {

class Stopwatch
{
public:
    double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

glm::vec3 imageValue(const FitProblem& problem, std::uint32_t texel, std::size_t direction)
{
    return gpu::unpackRgb9e5(problem.images[direction * problem.texelCount() + texel]);
}

// A model linear in what is stored: value(direction) = sum over basis of coefficient *
// basis(direction).
struct LinearModel
{
    std::size_t basisCount = 0;
    std::vector<double> basis;           // [basis, direction]
    std::vector<glm::vec3> coefficients; // [texel, basis]
};

void reconstructLinear(const LinearModel& model, const glm::uvec4& texels, const glm::vec4& weights,
                       std::vector<glm::vec3>& image)
{
    const std::size_t directions = image.size();
    std::fill(image.begin(), image.end(), glm::vec3(0.0f));
    for (std::size_t b = 0; b < model.basisCount; ++b) {
        glm::vec3 coefficient(0.0f);
        for (int c = 0; c < 4; ++c)
            coefficient += weights[c] * model.coefficients[texels[c] * model.basisCount + b];
        for (std::size_t d = 0; d < directions; ++d)
            image[d] += coefficient * float(model.basis[b * directions + d]);
    }
}

// sum over directions of weight * basis_a * basis_b. [basis, basis]
std::vector<double> gramMatrix(const FitProblem& problem, const LinearModel& model)
{
    const std::size_t n = model.basisCount;
    const std::size_t directions = problem.directionCount();
    std::vector<double> gram(n * n, 0.0);
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
            for (std::size_t d = 0; d < directions; ++d)
                gram[a * n + b] += double(problem.directions[d].w) *
                                   model.basis[a * directions + d] *
                                   model.basis[b * directions + d];
    return gram;
}

// sum over directions of weight * basis * radiance of one channel. [basis]
std::vector<double> projection(const FitProblem& problem, const LinearModel& model,
                               const std::vector<glm::vec3>& image, int channel)
{
    std::vector<double> right(model.basisCount, 0.0);
    for (std::size_t b = 0; b < model.basisCount; ++b)
        for (std::size_t d = 0; d < image.size(); ++d)
            right[b] += double(problem.directions[d].w) * model.basis[b * image.size() + d] *
                        double(image[d][channel]);
    return right;
}

// Real spherical harmonics up to band 2, without their constant factors: least squares absorbs
// them.
std::vector<double> harmonics(const glm::vec3& d, std::uint32_t bands)
{
    const double x = double(d.x), y = double(d.y), z = double(d.z);
    std::vector<double> values = {1.0, y, z, x};
    if (bands > 2)
        values.insert(values.end(), {x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y});
    return values;
}

template <class Solve>
void solveTexels(const FitProblem& problem, LinearModel& model, const Solve& solve)
{
    model.coefficients.assign(problem.texelCount() * model.basisCount, glm::vec3(0.0f));
    std::vector<glm::vec3> image(problem.directionCount());
    for (std::uint32_t t = 0; t < problem.texelCount(); ++t) {
        for (std::size_t d = 0; d < image.size(); ++d)
            image[d] = imageValue(problem, t, d);
        for (int channel = 0; channel < 3; ++channel) {
            const std::vector<double> x = solve(projection(problem, model, image, channel));
            for (std::size_t b = 0; b < model.basisCount; ++b)
                model.coefficients[t * model.basisCount + b][channel] = float(x[b]);
        }
    }
}

// Axes on a Fibonacci spiral over the hemisphere, the same sharpness for all; black.
std::vector<SgLobe> spiralLobes(std::uint32_t count, float sharpness)
{
    std::vector<SgLobe> lobes(count);
    for (std::uint32_t k = 0; k < count; ++k) {
        const float z = (float(k) + 0.5f) / float(count);
        const float azimuth = float(k) * 2.39996323f;
        const float radius = std::sqrt(1.0f - z * z);
        lobes[k].axis = {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
        lobes[k].logSharpness = std::log(sharpness);
    }
    return lobes;
}

LinearModel lobeBasis(const FitProblem& problem, const std::vector<SgLobe>& lobes)
{
    LinearModel model;
    model.basisCount = lobes.size();
    for (const SgLobe& lobe : lobes)
        for (const glm::vec4& d : problem.directions)
            model.basis.push_back(
                double(gpu::sgEvaluate(glm::vec3(d), lobe.axis, std::exp(lobe.logSharpness))));
    return model;
}

// The lobes with amplitudes = coefficients [texel, basis] x mixing [basis, lobe].
std::shared_ptr<const SgField> asLobes(const LinearModel& model, const std::vector<SgLobe>& lobes,
                                       const std::vector<double>& mixing)
{
    SgField field;
    field.lobeCount = std::uint32_t(lobes.size());
    const std::size_t texels = model.coefficients.size() / model.basisCount;
    for (std::size_t t = 0; t < texels; ++t)
        for (std::size_t k = 0; k < lobes.size(); ++k) {
            SgLobe lobe = lobes[k];
            for (std::size_t b = 0; b < model.basisCount; ++b)
                lobe.amplitude += model.coefficients[t * model.basisCount + b] *
                                  float(mixing[b * lobes.size() + k]);
            field.lobes.push_back(lobe);
        }
    return std::make_shared<SgField>(std::move(field));
}

// Spherical harmonics as 32 broad lobes of either sign: within 1 % of every basis function, so that
// the same shading draws them.
std::shared_ptr<const SgField> harmonicsAsLobes(const FitProblem& problem,
                                                const LinearModel& harmonics)
{
    // Half the directions at most: normal equations of more lobes than directions have no answer.
    const std::uint32_t count = std::min(32u, problem.directionCount() / 2);
    const std::vector<SgLobe> lobes = spiralLobes(count, 2.0f);
    const LinearModel basis = lobeBasis(problem, lobes);
    const std::vector<double> gram = gramMatrix(problem, basis);
    const std::size_t directions = problem.directionCount();
    std::vector<double> mixing;
    for (std::size_t b = 0; b < harmonics.basisCount; ++b) {
        std::vector<glm::vec3> function(directions);
        for (std::size_t d = 0; d < directions; ++d)
            function[d].x = float(harmonics.basis[b * directions + d]);
        const std::vector<double> x = solveDefinite(gram, projection(problem, basis, function, 0));
        mixing.insert(mixing.end(), x.begin(), x.end());
    }
    return asLobes(harmonics, lobes, mixing);
}

LightFieldModel toModel(LinearModel linear, std::string name, double seconds)
{
    LightFieldModel out;
    out.name = std::move(name);
    out.bytesPerTexel = double(linear.basisCount) * 3.0 * 2.0;
    out.seconds = seconds;
    out.reconstruct = [shared = std::make_shared<LinearModel>(std::move(linear))](
                          const glm::uvec4& texels, const glm::vec4& weights,
                          std::vector<glm::vec3>& image) {
        reconstructLinear(*shared, texels, weights, image);
    };
    return out;
}

} // namespace

LightFieldModel rawImageModel(const FitProblem& problem)
{
    LightFieldModel out;
    out.name = "raw images";
    out.bytesPerTexel = double(problem.directionCount()) * 4.0;
    out.reconstruct = [&problem](const glm::uvec4& texels, const glm::vec4& weights,
                                 std::vector<glm::vec3>& image) {
        for (std::size_t d = 0; d < image.size(); ++d) {
            image[d] = glm::vec3(0.0f);
            for (int c = 0; c < 4; ++c)
                image[d] += weights[c] * imageValue(problem, texels[c], d);
        }
    };
    return out;
}

LightFieldModel sphericalHarmonicModel(const FitProblem& problem, std::uint32_t bands)
{
    if (bands != 2 && bands != 3)
        throw Error("spherical harmonics of " + std::to_string(bands) + " bands; 2 or 3 are known");
    const Stopwatch watch;
    const std::size_t directions = problem.directionCount();
    LinearModel model;
    model.basisCount = std::size_t(bands) * bands;
    model.basis.resize(model.basisCount * directions);
    for (std::size_t d = 0; d < directions; ++d) {
        const std::vector<double> values = harmonics(glm::vec3(problem.directions[d]), bands);
        for (std::size_t b = 0; b < model.basisCount; ++b)
            model.basis[b * directions + d] = values[b];
    }
    const std::vector<double> gram = gramMatrix(problem, model);
    solveTexels(problem, model,
                [&](std::vector<double> right) { return solveDefinite(gram, std::move(right)); });
    const double seconds = watch.seconds();
    const auto lobes = harmonicsAsLobes(problem, model);
    LightFieldModel out = toModel(std::move(model), "SH L" + std::to_string(bands - 1), seconds);
    out.lobes = lobes;
    return out;
}

LightFieldModel fixedSgModel(const FitProblem& problem, std::uint32_t lobes)
{
    const Stopwatch watch;
    // Solid angle of a lobe, about 2 pi / sharpness, is its share of the hemisphere. Measured best
    // of 4, 6, 8 and 10 for eight lobes within 1 %.
    const std::vector<SgLobe> axes = spiralLobes(lobes, 0.75f * float(lobes));
    LinearModel model = lobeBasis(problem, axes);
    const std::vector<double> gram = gramMatrix(problem, model);
    solveTexels(problem, model,
                [&](const std::vector<double>& right) { return solveNonNegative(gram, right); });
    const double seconds = watch.seconds();
    std::vector<double> identity(std::size_t(lobes) * lobes, 0.0);
    for (std::size_t k = 0; k < lobes; ++k)
        identity[k * lobes + k] = 1.0;
    const auto field = asLobes(model, axes, identity);
    LightFieldModel out = toModel(std::move(model), std::to_string(lobes) + " fixed SGs", seconds);
    out.lobes = field;
    return out;
}

LightFieldModel freeSgModel(const FitProblem& problem, SgField field, std::string name,
                            double seconds)
{
    LightFieldModel out;
    out.name = std::move(name);
    out.bytesPerTexel = double(field.keptCount()) / double(std::max(problem.texelCount(), 1u)) *
                        12.0; // axis octahedral 2 x 16 bits, the rest fp16
    out.seconds = seconds;
    out.lobes = std::make_shared<SgField>(std::move(field));
    out.reconstruct = [&problem, shared = out.lobes](const glm::uvec4& texels,
                                                     const glm::vec4& weights,
                                                     std::vector<glm::vec3>& image) {
        std::fill(image.begin(), image.end(), glm::vec3(0.0f));
        for (std::uint32_t k = 0; k < shared->lobeCount; ++k) {
            const SgLobe lobe = interpolateLobe(*shared, texels, weights, k);
            if (lobe.amplitude == glm::vec3(0.0f))
                continue;
            const float sharpness = std::exp(lobe.logSharpness);
            for (std::size_t d = 0; d < image.size(); ++d)
                image[d] += lobe.amplitude *
                            gpu::sgEvaluate(glm::vec3(problem.directions[d]), lobe.axis, sharpness);
        }
    };
    return out;
}

} // namespace strandlight
