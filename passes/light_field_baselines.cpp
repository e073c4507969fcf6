#include "passes/light_field_baselines.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "engine/base/error.hpp"
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

// Gaussian elimination without pivoting: the matrix is symmetric positive definite.
std::vector<double> solveDefinite(std::vector<double> a, std::vector<double> x)
{
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t row = i + 1; row < n; ++row) {
            const double factor = a[row * n + i] / a[i * n + i];
            for (std::size_t column = i; column < n; ++column)
                a[row * n + column] -= factor * a[i * n + column];
            x[row] -= factor * x[i];
        }
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t column = i + 1; column < n; ++column)
            x[i] -= a[i * n + column] * x[column];
        x[i] /= a[i * n + i];
    }
    return x;
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

std::vector<double> solveNonNegative(const std::vector<double>& gram,
                                     const std::vector<double>& right)
{
    const std::size_t n = right.size();
    std::vector<double> x(n, 0.0);
    for (int sweep = 0; sweep < 1000; ++sweep) {
        double largestChange = 0.0, largest = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!(gram[i * n + i] > 0.0))
                continue;
            double rest = right[i];
            for (std::size_t j = 0; j < n; ++j)
                if (j != i)
                    rest -= gram[i * n + j] * x[j];
            const double next = std::max(0.0, rest / gram[i * n + i]);
            largestChange = std::max(largestChange, std::abs(next - x[i]));
            largest = std::max(largest, next);
            x[i] = next;
        }
        if (largestChange <= 1.0e-7 * largest)
            break;
    }
    return x;
}

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
    return toModel(std::move(model), "SH L" + std::to_string(bands - 1), watch.seconds());
}

LightFieldModel fixedSgModel(const FitProblem& problem, std::uint32_t lobes)
{
    const Stopwatch watch;
    const std::size_t directions = problem.directionCount();
    LinearModel model;
    model.basisCount = lobes;
    model.basis.resize(lobes * directions);
    for (std::uint32_t k = 0; k < lobes; ++k) {
        const float z = (float(k) + 0.5f) / float(lobes);
        const float azimuth = float(k) * 2.39996323f;
        const float radius = std::sqrt(1.0f - z * z);
        const glm::vec3 axis(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
        // Solid angle of a lobe, about 2 pi / sharpness, is its share of the hemisphere. Measured
        // best of 4, 6, 8 and 10 for eight lobes within 1 %.
        const float sharpness = 0.75f * float(lobes);
        for (std::size_t d = 0; d < directions; ++d)
            model.basis[k * directions + d] =
                double(gpu::sgEvaluate(glm::vec3(problem.directions[d]), axis, sharpness));
    }
    const std::vector<double> gram = gramMatrix(problem, model);
    solveTexels(problem, model,
                [&](const std::vector<double>& right) { return solveNonNegative(gram, right); });
    return toModel(std::move(model), std::to_string(lobes) + " fixed SGs", watch.seconds());
}

LightFieldModel freeSgModel(const FitProblem& problem, SgField field, std::string name,
                            double seconds)
{
    LightFieldModel out;
    out.name = std::move(name);
    out.bytesPerTexel =
        double(field.lobeCount) * 12.0; // axis octahedral 2 x 16 bits, the rest fp16
    out.seconds = seconds;
    out.reconstruct = [&problem, shared = std::make_shared<SgField>(std::move(field))](
                          const glm::uvec4& texels, const glm::vec4& weights,
                          std::vector<glm::vec3>& image) {
        std::fill(image.begin(), image.end(), glm::vec3(0.0f));
        for (std::uint32_t k = 0; k < shared->lobeCount; ++k) {
            glm::vec3 axis(0.0f), amplitude(0.0f);
            float logSharpness = 0.0f;
            for (int c = 0; c < 4; ++c) {
                const SgLobe& lobe = shared->lobes[std::size_t(texels[c]) * shared->lobeCount + k];
                axis += weights[c] * lobe.axis;
                logSharpness += weights[c] * lobe.logSharpness;
                amplitude += weights[c] * lobe.amplitude;
            }
            axis = gpu::safeNormalize(axis, glm::vec3(0.0f, 0.0f, 1.0f));
            const float sharpness = std::exp(logSharpness);
            for (std::size_t d = 0; d < image.size(); ++d)
                image[d] +=
                    amplitude * gpu::sgEvaluate(glm::vec3(problem.directions[d]), axis, sharpness);
        }
    };
    return out;
}

} // namespace strandlight
