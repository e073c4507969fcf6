#include "tests/unit/plain_flip.hpp"

#include <algorithm>
#include <cmath>

namespace strandlight::test {

namespace {

using glm::dvec3;

constexpr double kPi = 3.14159265358979323846;

// Linear sRGB to XYZ with the primaries as fractions, rows.
dvec3 xyzOf(dvec3 c)
{
    return {(10135552.0 * c.x + 8788810.0 * c.y + 4435075.0 * c.z) / 24577794.0,
            (2613072.0 * c.x + 8788810.0 * c.y + 887015.0 * c.z) / 12288897.0,
            (1425312.0 * c.x + 8788810.0 * c.y + 70074185.0 * c.z) / 73733382.0};
}

dvec3 rgbOf(dvec3 xyz)
{
    const dvec3 x = xyzOf({1, 0, 0}), y = xyzOf({0, 1, 0}), z = xyzOf({0, 0, 1});
    return glm::inverse(glm::dmat3(x, y, z)) * xyz;
}

const dvec3 kWhite = xyzOf(dvec3(1.0));

// Equation 1: Y Cx Cz.
dvec3 opponentOf(dvec3 rgb)
{
    const dvec3 r = xyzOf(rgb) / kWhite;
    return {116.0 * r.y - 16.0, 500.0 * (r.x - r.y), 200.0 * (r.y - r.z)};
}

dvec3 rgbOfOpponent(dvec3 o)
{
    const double y = (o.x + 16.0) / 116.0;
    return rgbOf(dvec3(o.y / 500.0 + y, y, y - o.z / 200.0) * kWhite);
}

// CIELAB, then the Hunt effect.
dvec3 huntOf(dvec3 rgb)
{
    const dvec3 r = xyzOf(rgb) / kWhite;
    const auto f = [](double t) {
        const double d = 6.0 / 29.0;
        return t > d * d * d ? std::pow(t, 1.0 / 3.0) : t / (3.0 * d * d) + 4.0 / 29.0;
    };
    const double l = 116.0 * f(r.y) - 16.0;
    return {l, 0.01 * l * 500.0 * (f(r.x) - f(r.y)), 0.01 * l * 200.0 * (f(r.y) - f(r.z))};
}

double hyab(dvec3 a, dvec3 b)
{
    return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

double colourError(dvec3 a, dvec3 b)
{
    const double largest = std::pow(hyab(huntOf({0, 1, 0}), huntOf({0, 0, 1})), 0.7);
    const double value = std::pow(hyab(huntOf(a), huntOf(b)), 0.7), knee = 0.4 * largest;
    return value < knee ? 0.95 / knee * value : 0.95 + (value - knee) / (largest - knee) * 0.05;
}

// Sum over a (2 r + 1)^2 kernel; outside pixels repeat the border.
template <class Kernel, class Value>
double filtered(const CpuImage& image, int x, int y, int radius, Kernel kernel, Value value)
{
    double sum = 0.0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
            const int px = std::clamp(x + i, 0, int(image.width) - 1);
            const int py = std::clamp(y + j, 0, int(image.height) - 1);
            sum += kernel(i, j) * value(dvec3(image.at(std::uint32_t(px), std::uint32_t(py))));
        }
    return sum;
}

// The picture behind the contrast sensitivity functions of the three channels, at one pixel.
dvec3 perceived(const CpuImage& image, int x, int y, double ppd)
{
    const int radius = int(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * ppd));
    dvec3 result;
    for (int channel = 0; channel < 3; ++channel) {
        const auto spread = [&](int i, int j) {
            const double d2 = (i * i + j * j) / (ppd * ppd);
            const auto term = [&](double a, double b) {
                return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * d2 / b);
            };
            return channel == 0   ? term(1.0, 0.0047)
                   : channel == 1 ? term(1.0, 0.0053)
                                  : term(34.1, 0.04) + term(13.5, 0.025);
        };
        double total = 0.0;
        for (int j = -radius; j <= radius; ++j)
            for (int i = -radius; i <= radius; ++i)
                total += spread(i, j);
        result[channel] =
            filtered(image, x, y, radius, spread, [&](dvec3 c) { return opponentOf(c)[channel]; }) /
            total;
    }
    return glm::clamp(rgbOfOpponent(result), 0.0, 1.0);
}

// Strength of edges (order 1) or points (order 2) at one pixel.
double feature(const CpuImage& image, int x, int y, double ppd, int order)
{
    const double deviation = 0.5 * 0.082 * ppd;
    const int radius = int(std::ceil(3.0 * deviation));
    const auto raw = [&](int i, int j) {
        const double g = std::exp(-(i * i + j * j) / (2.0 * deviation * deviation));
        return (order == 1 ? -double(i) : i * i / (deviation * deviation) - 1.0) * g;
    };
    double positive = 0.0, negative = 0.0;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i)
            (raw(i, j) > 0.0 ? positive : negative) += std::abs(raw(i, j));
    const auto balanced = [&](int i, int j) {
        const double k = raw(i, j);
        return k > 0.0 ? k / positive : k / negative;
    };
    const auto grey = [](dvec3 c) { return (opponentOf(c).x + 16.0) / 116.0; };
    const double gx = filtered(image, x, y, radius, balanced, grey);
    const double gy = filtered(
        image, x, y, radius, [&](int i, int j) { return balanced(j, i); }, grey);
    return std::sqrt(gx * gx + gy * gy);
}

} // namespace

std::vector<double> plainFlip(const CpuImage& image, const CpuImage& reference, double ppd)
{
    std::vector<double> errors;
    for (int y = 0; y < int(image.height); ++y)
        for (int x = 0; x < int(image.width); ++x) {
            const double colour =
                colourError(perceived(image, x, y, ppd), perceived(reference, x, y, ppd));
            double difference = 0.0;
            for (const int order : {1, 2})
                difference = std::max(difference, std::abs(feature(image, x, y, ppd, order) -
                                                           feature(reference, x, y, ppd, order)));
            errors.push_back(std::pow(colour, 1.0 - std::sqrt(difference / std::sqrt(2.0))));
        }
    return errors;
}

double plainFlipOfColours(dvec3 image, dvec3 reference)
{
    return colourError(image, reference);
}

} // namespace strandlight::test
