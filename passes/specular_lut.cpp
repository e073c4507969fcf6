// Fits SG mixtures to GGX slices by expectation maximisation over importance samples of the BRDF.
// Dempster, Laird, Rubin. Maximum Likelihood from Incomplete Data via the EM Algorithm. 1977
//
// A component is p(l) = exp(eta . l) max(l.z, 0) / Z(eta), eta = sharpness * axis in the plane of
// incidence. It is an exponential family, so the M-step solves mean(eta) = sample mean; one damped
// Newton step on ln Z does. Neighbouring cells start from one another, so a lobe keeps its identity
// across the table and interpolates.
#include "passes/specular_lut.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace strandlight {
namespace {

constexpr int kLobes = 4;
constexpr int kRows = 6;
constexpr int kFirstIterations = 120; // the first cell has no neighbour to start from
constexpr int kIterations = 14;

struct Sample
{
    double x, z;   // direction; y only enters through symmetry
    double weight; // D V (n.l) / pdf
};

struct Slice
{
    std::vector<Sample> samples;
    double scale = 0.0;
    double bias = 0.0;
};

struct Component
{
    double weight = 0.0;
    double x = 0.0; // eta
    double z = 0.0;
    double meanX = 0.0; // of its share of the slice, cosine included
    double meanZ = 1.0;
};

using Mixture = std::array<Component, kLobes>;

// Height-correlated Smith; the same BRDF as shaders/shared/brdf.h, in double.
double ggxVisibility(double cosLight, double cosView, double alpha2)
{
    return 0.5 / (cosLight * std::sqrt(alpha2 + (1.0 - alpha2) * cosView * cosView) +
                  cosView * std::sqrt(alpha2 + (1.0 - alpha2) * cosLight * cosLight));
}

// Half vectors on a radial x azimuthal grid of the distribution; u = 1 - (1 - t)^2 puts more of
// them into the tail.
Slice sampleSlice(double alpha, double cosView)
{
    constexpr int kRadial = 36;
    constexpr int kAzimuth = 16;
    const double alpha2 = alpha * alpha;
    const double viewX = -std::sqrt(std::max(1.0 - cosView * cosView, 0.0));
    Slice slice;
    for (int i = 0; i < kRadial; ++i)
        for (int j = 0; j < kAzimuth; ++j) {
            const double t = (i + 0.5) / kRadial;
            const double u = 1.0 - (1.0 - t) * (1.0 - t);
            const double phi =
                M_PI * (j + 0.5) / kAzimuth; // half the circle: the slice is symmetric in y
            const double cosHalf = std::sqrt((1.0 - u) / (1.0 + (alpha2 - 1.0) * u));
            const double halfX = std::sqrt(1.0 - cosHalf * cosHalf) * std::cos(phi);
            const double viewHalf = viewX * halfX + cosView * cosHalf;
            const double x = 2.0 * viewHalf * halfX - viewX;
            const double z = 2.0 * viewHalf * cosHalf - cosView;
            if (viewHalf <= 0.0 || z <= 0.0)
                continue;
            // D V (n.l) over the density D (n.h) / (4 v.h) of l
            const double weight = ggxVisibility(z, cosView, alpha2) * z * 4.0 * viewHalf / cosHalf *
                                  2.0 * (1.0 - t) / (kRadial * kAzimuth);
            const double schlick = std::pow(1.0 - viewHalf, 5.0);
            slice.samples.push_back({x, z, weight});
            slice.scale += weight * (1.0 - schlick);
            slice.bias += weight * schlick;
        }
    return slice;
}

// sgIrradiance in double: the fit differentiates it numerically.
double irradiance(double lambda, double cosine)
{
    const auto phi = [](double x) { return x < 1e-12 ? 1.0 : -std::expm1(-x) / x; };
    lambda = std::max(lambda, 1e-4);
    const double e = std::exp(-lambda);
    const double upper = lambda < 0.02 ? 0.5 - lambda / 6.0 + lambda * lambda / 24.0 -
                                             lambda * lambda * lambda / 120.0
                                       : (1.0 - phi(lambda)) / lambda;
    const double lower =
        lambda < 0.02
            ? e * (0.5 - lambda / 3.0 + lambda * lambda / 8.0 - lambda * lambda * lambda / 30.0)
            : e * (phi(lambda) - e) / lambda;
    const double t =
        lambda * std::sqrt(0.5 * ((lambda + 2.73608316) * lambda + 17.02129778) /
                           (((lambda + 4.01008267) * lambda + 15.21915626) * lambda + 76.08789627));
    const double tc = t * cosine;
    const double blend = 0.5 * (cosine * std::erfc(-tc) + std::erfc(t)) -
                         std::exp(-tc * tc) * std::expm1(t * t * (cosine * cosine - 1.0)) /
                             (2.0 * std::sqrt(M_PI) * t);
    return 2.0 * M_PI * (lower + (upper - lower) * std::clamp(blend, 0.0, 1.0));
}

// ln Z(eta)
double logPartition(double x, double z)
{
    const double lambda = std::max(std::hypot(x, z), 1e-6);
    return std::log(irradiance(lambda, z / lambda)) + lambda;
}

// One Newton step towards the eta whose mean direction is (meanX, meanZ); ln Z is convex, its
// derivatives are numeric.
void stepTowardsMean(Component& c, double meanX, double meanZ)
{
    const double length = std::hypot(c.x, c.z);
    const double h = 1e-3 * (1.0 + length);
    const double here = logPartition(c.x, c.z);
    const double right = logPartition(c.x + h, c.z), left = logPartition(c.x - h, c.z);
    const double up = logPartition(c.x, c.z + h), down = logPartition(c.x, c.z - h);
    const double both = logPartition(c.x + h, c.z + h) + logPartition(c.x - h, c.z - h);
    const double gx = (right - left) / (2.0 * h) - meanX;
    const double gz = (up - down) / (2.0 * h) - meanZ;
    const double hxx = (right - 2.0 * here + left) / (h * h);
    const double hzz = (up - 2.0 * here + down) / (h * h);
    const double hxz = (both - right - left - up - down + 2.0 * here) / (2.0 * h * h);
    const double determinant = hxx * hzz - hxz * hxz;
    if (!(determinant > 1e-14 && hxx > 0.0))
        return;
    double dx = -(hzz * gx - hxz * gz) / determinant;
    double dz = -(hxx * gz - hxz * gx) / determinant;
    const double reach = 0.5 * (length + 1.0);
    const double shrink = std::min(1.0, reach / std::max(std::hypot(dx, dz), 1e-30));
    c.x += dx * shrink;
    // Deep below the horizon only the rim of a lobe shows and its normalisation loses its digits.
    c.z = std::max(c.z + dz * shrink, -4.0);
}

void fitMixture(const Slice& slice, Mixture& mixture, int iterations)
{
    const double energy = slice.scale + slice.bias;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        std::array<double, kLobes> offset{}, weight{}, sumX{}, sumZ{};
        for (int k = 0; k < kLobes; ++k)
            offset[k] = std::log(std::max(mixture[k].weight, 1e-12)) -
                        logPartition(mixture[k].x, mixture[k].z);
        for (const Sample& s : slice.samples) {
            std::array<double, kLobes> density{};
            double total = 1e-300;
            for (int k = 0; k < kLobes; ++k) {
                density[k] = std::exp(offset[k] + s.x * mixture[k].x + s.z * mixture[k].z);
                total += density[k];
            }
            for (int k = 0; k < kLobes; ++k) {
                const double share = s.weight * density[k] / total;
                weight[k] += share;
                sumX[k] += share * s.x;
                sumZ[k] += share * s.z;
            }
        }
        for (int k = 0; k < kLobes; ++k) {
            mixture[k].weight = weight[k] / energy;
            if (!(weight[k] > 1e-9 * energy))
                continue;
            mixture[k].meanX = sumX[k] / weight[k];
            mixture[k].meanZ = sumZ[k] / weight[k];
            stepTowardsMean(mixture[k], mixture[k].meanX, mixture[k].meanZ);
        }
    }
}

// Four concentric lobes about the mirror direction, from the core of GGX to its tail.
Mixture startMixture(double alpha, double cosView)
{
    const double sine = std::sqrt(std::max(1.0 - cosView * cosView, 0.0));
    Mixture mixture;
    for (int k = 0; k < kLobes; ++k) {
        const double sharpness = 1.0 / (alpha * alpha) * std::pow(6.0, -k);
        mixture[k] = {1.0 / kLobes, sharpness * sine, sharpness * cosView, sine, cosView};
    }
    return mixture;
}

// Direction times ln(1 + sharpness): the form that interpolates (decodeSpecularLobe).
glm::vec2 encodeLobe(double x, double z, double sharpness)
{
    const double scale = std::log1p(sharpness) / std::max(std::hypot(x, z), 1e-9);
    return {float(x * scale), float(z * scale)};
}

void storeCell(SpecularTable& table, std::uint32_t a, std::uint32_t v, const Slice& slice,
               const Mixture& mixture)
{
    for (int k = 0; k < kLobes; ++k) {
        const Component& c = mixture[k];
        const glm::vec2 lobe = encodeLobe(c.x, c.z, std::hypot(c.x, c.z));
        const double extra = k == 0 ? slice.scale : (k == 1 ? slice.bias : 0.0);
        table.rows[k].at(a, v) = glm::vec4(lobe, c.weight, extra);
        const double length = std::min(std::hypot(c.meanX, c.meanZ), 1.0);
        const glm::vec2 mean =
            encodeLobe(c.meanX, c.meanZ, gpu::sgSharpnessFromMeanLength(float(length)));
        glm::vec4& pair = table.rows[kLobes + k / 2].at(a, v);
        pair[2 * (k % 2)] = mean.x;
        pair[2 * (k % 2) + 1] = mean.y;
    }
}

SpecularTable fitTable()
{
    constexpr std::uint32_t kAlphas = gpu::kSpecularTableAlphas;
    constexpr std::uint32_t kViews = gpu::kSpecularTableViews;
    SpecularTable table;
    table.rows.assign(kRows, CpuImage(kAlphas, kViews));
    std::array<Mixture, kViews> column{}; // the last alpha's fits, by view
    double lastAlpha = 0.0;
    for (std::uint32_t a = 0; a < kAlphas; ++a) {
        const double alpha =
            std::pow(double(gpu::kSpecularTableMinAlpha), 1.0 - double(a) / (kAlphas - 1));
        for (std::uint32_t v = 0; v < kViews; ++v) {
            // The last row stands for views within half a degree of grazing, where the slice itself
            // degenerates.
            const double cosView = std::max(std::cos(0.5 * M_PI * v / (kViews - 1)), 0.008);
            const Slice slice = sampleSlice(alpha, cosView);
            Mixture& mixture = column[v];
            int iterations = kIterations;
            if (a == 0) {
                mixture = v == 0 ? startMixture(alpha, cosView) : column[v - 1];
                iterations = kFirstIterations;
            } else {
                const double wider =
                    (lastAlpha / alpha) * (lastAlpha / alpha); // sharpness goes with 1 / alpha^2
                for (Component& c : mixture) {
                    c.x *= wider;
                    c.z *= wider;
                }
            }
            fitMixture(slice, mixture, iterations);
            storeCell(table, a, v, slice, mixture);
        }
        lastAlpha = alpha;
    }
    return table;
}

glm::vec4 bilinear(const CpuImage& image, glm::vec2 uv)
{
    const float x = uv.x * float(image.width) - 0.5f;
    const float y = uv.y * float(image.height) - 0.5f;
    const std::uint32_t x0 = std::min(std::uint32_t(std::max(x, 0.0f)), image.width - 2);
    const std::uint32_t y0 = std::min(std::uint32_t(std::max(y, 0.0f)), image.height - 2);
    const float fx = std::clamp(x - float(x0), 0.0f, 1.0f);
    const float fy = std::clamp(y - float(y0), 0.0f, 1.0f);
    return glm::mix(glm::mix(image.at(x0, y0), image.at(x0 + 1, y0), fx),
                    glm::mix(image.at(x0, y0 + 1), image.at(x0 + 1, y0 + 1), fx), fy);
}

} // namespace

gpu::SgMixture SpecularTable::mixture(float alpha, glm::vec3 normal, glm::vec3 view) const
{
    const glm::vec2 uv = gpu::specularTableUv(alpha, glm::dot(normal, view));
    return gpu::specularMixture(bilinear(rows[0], uv), bilinear(rows[1], uv), bilinear(rows[2], uv),
                                bilinear(rows[3], uv), normal, view);
}

const SpecularTable& specularTable()
{
    static const SpecularTable table = fitTable();
    return table;
}

Image uploadSpecularTable(Context& context)
{
    const SpecularTable& table = specularTable();
    const ImageDesc desc{gpu::kSpecularTableAlphas, gpu::kSpecularTableViews, kRows,
                         Format::RGBA32F, 1};
    Image image(context, desc, "specular table");
    for (std::uint32_t k = 0; k < kRows; ++k)
        image.upload(table.rows[k], k);
    return image;
}

} // namespace strandlight
