#include "passes/fit_probes.hpp"

#include <optional>
#include <utility>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"

namespace strandlight {
namespace {

// Barycentric weights of corners 1 and 2 at an atlas place; empty outside of the triangle.
std::optional<glm::vec2> weightsAt(const Atlas& atlas, std::uint32_t triangle, glm::dvec2 place)
{
    const AtlasCorner* corner = &atlas.corners[std::size_t(triangle) * 3];
    const glm::dvec2 a = corner[0].uv;
    const glm::dvec2 ab = glm::dvec2(corner[1].uv) - a;
    const glm::dvec2 ac = glm::dvec2(corner[2].uv) - a;
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (area == 0.0)
        return std::nullopt;
    const glm::dvec2 ap = place - a;
    const double u = (ap.x * ac.y - ap.y * ac.x) / area;
    const double v = (ab.x * ap.y - ab.y * ap.x) / area;
    constexpr double kRounding = 1e-6; // the diagonal of two triangles belongs to both
    if (u < -kRounding || v < -kRounding || u + v > 1.0 + kRounding)
        return std::nullopt;
    return glm::vec2(u, v);
}

std::optional<AtlasTexel> locate(const Atlas& atlas, const glm::uvec4& corners)
{
    const AtlasTexel& first = atlas.texels[corners.x];
    const glm::dvec2 place(double(first.x) + 1.0, double(first.y) + 1.0); // centres are at + 0.5
    const std::size_t triangles = atlas.corners.size() / 3;
    for (std::uint32_t t = 0; t < triangles; ++t)
        if (const std::optional<glm::vec2> weights = weightsAt(atlas, t, place)) {
            AtlasTexel found = first;
            found.triangle = t;
            found.barycentric = *weights;
            return found;
        }
    return std::nullopt;
}

// Probes inside geometry have no image: they go too.
void attachImages(FitProbes& probes, const CpuLightfield& truth)
{
    FitProbes kept;
    const std::size_t words = std::size_t(truth.size) * truth.size;
    for (std::size_t p = 0; p < probes.texels.size(); ++p) {
        if (truth.valid[p] == 0)
            continue;
        kept.texels.push_back(probes.texels[p]);
        kept.weights.push_back(probes.weights[p]);
        const auto image = truth.radiance.begin() + std::ptrdiff_t(p * words);
        kept.images.insert(kept.images.end(), image, image + std::ptrdiff_t(words));
    }
    probes = std::move(kept);
}

} // namespace

CpuLightfield captureTexels(Context& context, const Scene& scene, GpuScene& device,
                            const Atlas& atlas, const std::vector<AtlasTexel>& places,
                            const CaptureSettings& settings, const char* title)
{
    std::vector<gpu::CapturePoint> points;
    for (const AtlasTexel& place : places)
        points.push_back(capturePoint(scene, atlas, place));
    LightfieldCapture work(context, device, std::move(points), settings);
    Progress progress(title, places.size());
    while (!work.step())
        progress.update(work.completedTexels());
    progress.update(places.size());
    return downloadLightfield(work.finish());
}

std::vector<AtlasTexel> locateProbes(const Atlas& atlas, FitProbes& probes)
{
    std::vector<AtlasTexel> places;
    FitProbes kept;
    for (std::size_t p = 0; p < probes.texels.size(); ++p) {
        const std::optional<AtlasTexel> place = locate(atlas, probes.texels[p]);
        if (!place)
            continue;
        places.push_back(*place);
        kept.texels.push_back(probes.texels[p]);
        kept.weights.push_back(probes.weights[p]);
    }
    probes = std::move(kept);
    return places;
}

FitProbes captureProbes(Context& context, const Scene& scene, GpuScene& device, const Atlas& atlas,
                        const FitProblem& problem, std::uint32_t count,
                        const CaptureSettings& settings)
{
    FitProbes probes = cellCentreProbes(problem, count);
    const std::vector<AtlasTexel> places = locateProbes(atlas, probes);
    if (places.empty())
        throw Error("no point lies between four texels: the atlas of " +
                    std::to_string(atlas.resolution) + " texels is too small");
    attachImages(probes,
                 captureTexels(context, scene, device, atlas, places, settings, "truth between"));
    return probes;
}

} // namespace strandlight
