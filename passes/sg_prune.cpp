#include "passes/sg_prune.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

#include "engine/base/assert.hpp"
#include "shaders/shared/rgb9e5.h"
#include "shaders/shared/sg.h"

namespace strandlight {
namespace {

// On the diagonal of the Gram matrix, where the sharpest lobe of an image has about 2e-3: lobes
// that coincide must not divide by zero, and none that lies below the horizon may take over much
// light.
constexpr double kRidge = 1.0e-5;

// Inverse of a symmetric positive definite matrix by Gauss-Jordan. [n, n]
void invert(std::vector<double>& m, std::size_t n)
{
    for (std::size_t p = 0; p < n; ++p) {
        const double pivot = 1.0 / m[p * n + p];
        m[p * n + p] = 1.0;
        for (std::size_t j = 0; j < n; ++j)
            m[p * n + j] *= pivot;
        for (std::size_t i = 0; i < n; ++i) {
            if (i == p)
                continue;
            const double factor = m[i * n + p];
            m[i * n + p] = 0.0;
            for (std::size_t j = 0; j < n; ++j)
                m[i * n + j] -= factor * m[p * n + j];
        }
    }
}

// One texel's lobes while they are dropped one after the other.
struct TexelLobes
{
    std::uint32_t texel = 0;
    std::vector<double> inverse;       // [lobe, lobe] of the Gram matrix of the kept lobes
    std::vector<glm::dvec3> amplitude; // [lobe] relative to the texel's mean radiance
    double squaredError = 0.0;         // of the fit
};

TexelLobes measureTexel(const FitProblem& problem, const FitSettings& settings,
                        const SgField& field, std::uint32_t texel)
{
    const std::size_t n = field.lobeCount;
    const SgLobe* lobes = &field.lobes[std::size_t(texel) * n];
    const double mean = std::abs(double(problem.scales[texel]));
    TexelLobes out{texel, std::vector<double>(n * n, 0.0), {}, 0.0};
    std::vector<double> value(n);
    for (std::uint32_t d = 0; d < problem.directionCount(); ++d) {
        const glm::dvec3 target(
            gpu::unpackRgb9e5(problem.images[std::size_t(d) * problem.texelCount() + texel]));
        const double weight =
            double(problem.directions[d].w) /
            (1.0 + double(settings.peakSoftening) * (target.x + target.y + target.z) / 3.0 / mean);
        glm::dvec3 residual = -target;
        for (std::size_t k = 0; k < n; ++k) {
            value[k] = double(gpu::sgEvaluate(glm::vec3(problem.directions[d]), lobes[k].axis,
                                              std::exp(lobes[k].logSharpness)));
            residual += value[k] * glm::dvec3(lobes[k].amplitude);
        }
        if (problem.scales[texel] > 0.0f)
            out.squaredError += weight * glm::dot(residual, residual) / (mean * mean);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j)
                out.inverse[i * n + j] += weight * value[i] * value[j];
    }
    for (std::size_t i = 0; i < n; ++i) {
        out.amplitude.push_back(glm::dvec3(lobes[i].amplitude) / mean);
        out.inverse[i * n + i] += kRidge;
        for (std::size_t j = 0; j < i; ++j)
            out.inverse[j * n + i] = out.inverse[i * n + j];
    }
    invert(out.inverse, n);
    return out;
}

// The lobes of one tile, and what it costs to do without them.
class Tile
{
public:
    Tile(const FitProblem& problem, const FitSettings& settings, const SgField& field,
         const std::vector<std::uint32_t>& texels)
        : lobeCount_(field.lobeCount), mask_(field.allLobes())
    {
        for (const std::uint32_t texel : texels)
            texels_.push_back(measureTexel(problem, settings, field, texel));
    }

    std::uint32_t mask() const { return mask_; }
    std::size_t texelCount() const { return texels_.size(); }
    double squaredError() const
    {
        double sum = 0.0;
        for (const TexelLobes& texel : texels_)
            sum += texel.squaredError;
        return sum;
    }

    // The cheapest kept lobe, and by how much the squared error grows without it.
    std::pair<double, std::uint32_t> cheapest() const
    {
        std::pair<double, std::uint32_t> best(HUGE_VAL, 0);
        for (std::uint32_t k = 0; k < lobeCount_; ++k)
            if ((mask_ >> k & 1u) != 0u)
                best = std::min(best, {costOf(k), k});
        return best;
    }

    void drop(std::uint32_t lobe)
    {
        const std::size_t n = lobeCount_;
        for (TexelLobes& t : texels_) {
            const double pivot = 1.0 / t.inverse[lobe * n + lobe];
            const std::vector<double> column(t.inverse.begin() + std::ptrdiff_t(lobe * n),
                                             t.inverse.begin() + std::ptrdiff_t(lobe * n + n));
            const glm::dvec3 removed = t.amplitude[lobe];
            for (std::size_t i = 0; i < n; ++i) {
                t.amplitude[i] -= removed * (column[i] * pivot);
                for (std::size_t j = 0; j < n; ++j)
                    t.inverse[i * n + j] -= column[i] * column[j] * pivot;
            }
            t.amplitude[lobe] = glm::dvec3(0.0);
        }
        mask_ &= ~(1u << lobe);
    }

    void store(const FitProblem& problem, SgField& field) const
    {
        for (const TexelLobes& t : texels_)
            for (std::uint32_t k = 0; k < lobeCount_; ++k) {
                const double mean = std::abs(double(problem.scales[t.texel]));
                field.lobes[std::size_t(t.texel) * lobeCount_ + k].amplitude =
                    glm::max(glm::vec3(t.amplitude[k] * mean), glm::vec3(0.0f));
            }
    }

private:
    double costOf(std::uint32_t lobe) const
    {
        double sum = 0.0;
        for (const TexelLobes& t : texels_)
            sum += glm::dot(t.amplitude[lobe], t.amplitude[lobe]) /
                   t.inverse[std::size_t(lobe) * lobeCount_ + lobe];
        return sum;
    }

    std::uint32_t lobeCount_;
    std::uint32_t mask_;
    std::vector<TexelLobes> texels_;
};

struct Removal
{
    std::uint32_t lobe;
    double cost; // growth of the tile's squared error
};

// Every lobe of a tile, in the order in which they should go.
std::vector<Removal> orderRemovals(Tile tile)
{
    std::vector<Removal> order;
    while (tile.mask() != 0u) {
        const auto [cost, lobe] = tile.cheapest();
        order.push_back({lobe, std::max(cost, 0.0)});
        tile.drop(lobe);
    }
    return order;
}

// How much a picture minds an error of this texel's lobes, which is measured against its mean
// radiance. The root is half way to the radiance itself: a dark corner matters less than a lit
// wall. A mirror shows every lobe, a rough surface their sum. Without the gloss FLIP of the
// built-in room grows three times as much for the same bytes, without the root the error at texels
// by 3 % more.
double visibility(const FitProblem& problem, std::uint32_t texel)
{
    constexpr double kGloss = 100.0;
    const double gloss = problem.gloss.empty() ? 0.0 : double(problem.gloss[texel]);
    return std::sqrt(std::abs(double(problem.scales[texel]))) * (1.0 + kGloss * gloss);
}

// How many lobes go in each tile: always the one that is missed least for what it frees, while the
// budget lasts. `worth`: of a tile's error, per texel.
std::vector<std::size_t> spendBudget(const std::vector<std::vector<Removal>>& orders,
                                     const std::vector<double>& worth, double budget)
{
    using Next = std::tuple<double, std::size_t>; // worth, tile
    std::priority_queue<Next, std::vector<Next>, std::greater<>> queue;
    std::vector<std::size_t> count(orders.size(), 0);
    const auto offer = [&](std::size_t tile) {
        if (count[tile] < orders[tile].size())
            queue.emplace(orders[tile][count[tile]].cost * worth[tile], tile);
    };
    for (std::size_t tile = 0; tile < orders.size(); ++tile)
        offer(tile);
    for (double spent = 0.0; !queue.empty();) {
        const std::size_t tile = std::get<1>(queue.top());
        queue.pop();
        spent += orders[tile][count[tile]].cost;
        if (spent > budget)
            break;
        ++count[tile];
        offer(tile);
    }
    return count;
}

} // namespace

void pruneLobes(const FitProblem& problem, const FitSettings& settings, SgField& field)
{
    STRANDLIGHT_ASSERT_EQ(problem.tiles.tileOf.size(), problem.texelCount());
    std::vector<std::vector<std::uint32_t>> texels(problem.tiles.count);
    for (std::uint32_t t = 0; t < problem.texelCount(); ++t)
        texels[problem.tiles.tileOf[t]].push_back(t);

    // A tile's removals do not depend on other tiles: only their order and costs are kept.
    std::vector<std::vector<Removal>> orders;
    std::vector<double> worth;
    double squaredError = 0.0;
    for (const std::vector<std::uint32_t>& members : texels) {
        Tile tile(problem, settings, field, members);
        squaredError += tile.squaredError();
        double sum = 0.0;
        for (const std::uint32_t t : members)
            sum += visibility(problem, t);
        worth.push_back(sum / double(members.size() * members.size()));
        orders.push_back(orderRemovals(std::move(tile)));
    }
    const double growth = 1.0 + double(settings.lobeError);
    const std::vector<std::size_t> dropped =
        spendBudget(orders, worth, squaredError * (growth * growth - 1.0));

    field.tileSize = settings.lobeTile;
    field.kept.assign(problem.texelCount(), 0u);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        Tile tile(problem, settings, field, texels[i]);
        for (std::size_t step = 0; step < dropped[i]; ++step)
            tile.drop(orders[i][step].lobe);
        tile.store(problem, field);
        for (const std::uint32_t texel : texels[i])
            field.kept[texel] = tile.mask();
    }
}

void countDropped(const FitProblem& problem, const SgField& field, FitStatistics& statistics)
{
    if (field.kept.empty())
        return;
    statistics.lobesDropped = field.lobes.size() - field.keptCount();
    statistics.tiles = problem.tiles.count;
    std::vector<std::uint8_t> dark(problem.tiles.count, 0);
    for (std::size_t t = 0; t < field.kept.size(); ++t)
        dark[problem.tiles.tileOf[t]] = field.kept[t] == 0u ? 1 : 0;
    statistics.darkTiles = std::uint64_t(std::count(dark.begin(), dark.end(), 1));
}

} // namespace strandlight
