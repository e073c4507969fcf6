#include "passes/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/base/error.hpp"
#include "shaders/shared/rgb9e5.h"

namespace strandlight {
namespace {

// Sums over points of squared radiance errors and of irradiance errors.
struct ErrorSums
{
    double squares = 0.0;
    double irradianceError = 0.0;
    double irradiance = 0.0;
    std::uint32_t points = 0;

    void add(const FitProblem& problem, const std::vector<glm::vec3>& image,
             const std::vector<glm::vec3>& truth)
    {
        glm::dvec3 difference(0.0), total(0.0);
        for (std::size_t d = 0; d < image.size(); ++d) {
            const glm::dvec3 error = glm::dvec3(image[d]) - glm::dvec3(truth[d]);
            const double weight = double(problem.directions[d].w);
            squares += weight * glm::dot(error, error) / 3.0;
            difference += weight * double(problem.directions[d].z) * error;
            total += weight * double(problem.directions[d].z) * glm::dvec3(truth[d]);
        }
        for (int c = 0; c < 3; ++c) {
            irradianceError += std::abs(difference[c]);
            irradiance += total[c];
        }
        ++points;
    }
    double rmse() const
    {
        return points > 0 ? std::sqrt(squares / points) : std::numeric_limits<double>::quiet_NaN();
    }
    double relativeIrradiance() const
    {
        return irradiance > 0.0 ? irradianceError / irradiance
                                : std::numeric_limits<double>::quiet_NaN();
    }
};

std::vector<std::uint32_t> pickTexels(const FitProblem& problem, std::uint32_t maximum)
{
    std::vector<std::uint32_t> known;
    for (std::uint32_t t = 0; t < problem.texelCount(); ++t)
        if (problem.scales[t] > 0.0f)
            known.push_back(t);
    const std::size_t stride = std::max<std::size_t>(1, (known.size() + maximum - 1) / maximum);
    std::vector<std::uint32_t> picked;
    for (std::size_t i = 0; i < known.size(); i += stride)
        picked.push_back(known[i]);
    return picked;
}

std::vector<glm::vec3> texelImage(const FitProblem& problem, std::uint32_t texel)
{
    std::vector<glm::vec3> image(problem.directionCount());
    for (std::size_t d = 0; d < image.size(); ++d)
        image[d] = gpu::unpackRgb9e5(problem.images[d * problem.texelCount() + texel]);
    return image;
}

FitReportRow measure(const FitProblem& problem, const FitProbes& probes,
                     const std::vector<std::uint32_t>& texels, const LightFieldModel& model)
{
    const std::size_t directions = problem.directionCount();
    std::vector<glm::vec3> image(directions), truth(directions);
    ErrorSums atTexels, between;
    for (const std::uint32_t texel : texels) {
        model.reconstruct(glm::uvec4(texel), glm::vec4(1.0f, 0.0f, 0.0f, 0.0f), image);
        atTexels.add(problem, image, texelImage(problem, texel));
    }
    const std::size_t known = probes.images.empty() ? 0 : probes.texels.size();
    for (std::size_t p = 0; p < known; ++p) {
        model.reconstruct(probes.texels[p], probes.weights[p], image);
        for (std::size_t d = 0; d < directions; ++d)
            truth[d] = gpu::unpackRgb9e5(probes.images[p * directions + d]);
        between.add(problem, image, truth);
    }
    return {model.name,
            atTexels.rmse(),
            between.rmse(),
            atTexels.relativeIrradiance(),
            between.relativeIrradiance(),
            model.bytesPerTexel,
            model.seconds};
}

} // namespace

FitProbes cellCentreProbes(const FitProblem& problem, std::uint32_t count)
{
    std::vector<glm::uvec4> known;
    for (std::uint32_t cell = 0; cell < problem.cells.cellCount; ++cell) {
        const glm::uvec4 corners = problem.cells.cornersOf(cell);
        bool whole = corners.x != corners.y;
        for (int c = 0; c < 4; ++c)
            whole = whole && problem.scales[corners[c]] > 0.0f;
        if (whole)
            known.push_back(corners);
    }
    const std::size_t stride =
        std::max<std::size_t>(1, (known.size() + count - 1) / std::max(count, 1u));
    FitProbes probes;
    for (std::size_t i = 0; i < known.size(); i += stride)
        probes.texels.push_back(known[i]);
    probes.weights.assign(probes.texels.size(), glm::vec4(0.25f));
    return probes;
}

FitReport compareFits(const FitProblem& problem, const FitProbes& probes,
                      const std::vector<LightFieldModel>& models, std::uint32_t maximumTexels)
{
    if (!probes.images.empty() &&
        probes.images.size() != probes.texels.size() * problem.directionCount())
        throw Error("fit report: " + std::to_string(probes.texels.size()) + " probes with " +
                    std::to_string(probes.images.size()) + " words, expected " +
                    std::to_string(problem.directionCount()) + " each");
    const std::vector<std::uint32_t> texels = pickTexels(problem, maximumTexels);
    FitReport report;
    report.texels = std::uint32_t(texels.size());
    report.probes = probes.images.empty() ? 0 : std::uint32_t(probes.texels.size());

    ErrorSums signal;
    const std::vector<glm::vec3> black(problem.directionCount(), glm::vec3(0.0f));
    for (const std::uint32_t texel : texels)
        signal.add(problem, black, texelImage(problem, texel));
    report.signalRms = signal.rmse();
    for (const LightFieldModel& model : models)
        report.rows.push_back(measure(problem, probes, texels, model));
    return report;
}

std::string FitReport::text() const
{
    char line[160];
    std::snprintf(line, sizeof(line), "signal RMS %.4f, %u texels, %u points between\n", signalRms,
                  texels, probes);
    std::string out = line;
    out += "model              RMSE texel  between   irradiance texel  between   bytes/texel  "
           "seconds\n";
    for (const FitReportRow& row : rows) {
        std::snprintf(line, sizeof(line), "%-18s %10.4f %8.4f %18.4f %8.4f %13.0f %8.2f\n",
                      row.name.c_str(), row.texelRmse, row.interpolatedRmse, row.texelIrradiance,
                      row.interpolatedIrradiance, row.bytesPerTexel, row.seconds);
        out += line;
    }
    return out;
}

} // namespace strandlight
