#include "engine/base/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "engine/base/assert.hpp"
#include "engine/base/cie_lab.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

namespace {

constexpr double kPi = 3.14159265358979323846;

// The paper's constants, by its names.
constexpr double kQc = 0.7;  // exponent of the colour difference
constexpr double kPc = 0.4;  // part of the largest colour difference ...
constexpr double kPt = 0.95; // ... that is mapped to [0, kPt]
constexpr double kW = 0.082; // feature width in degrees
constexpr double kQf = 0.5;  // exponent of the feature difference

// [height, width]
using Plane = std::vector<double>;

struct Size
{
    int width = 0;
    int height = 0;
    std::size_t count() const
    {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
};

// Symmetric kernel of 2 r + 1 values; outside pixels repeat the border.
Plane convolveRows(const Plane& in, Size size, const std::vector<double>& kernel)
{
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane out(in.size());
    for (int y = 0; y < size.height; ++y) {
        const double* row = &in[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width)];
        for (int x = 0; x < size.width; ++x) {
            double sum = 0.0;
            for (int k = -radius; k <= radius; ++k)
                sum += kernel[static_cast<std::size_t>(k + radius)] *
                       row[std::clamp(x + k, 0, size.width - 1)];
            out[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                static_cast<std::size_t>(x)] = sum;
        }
    }
    return out;
}

Plane transpose(const Plane& in, Size size)
{
    Plane out(in.size());
    const auto width = static_cast<std::size_t>(size.width);
    const auto height = static_cast<std::size_t>(size.height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            out[x * height + y] = in[y * width + x];
    return out;
}

Plane convolve(const Plane& in, Size size, const std::vector<double>& kernelX,
               const std::vector<double>& kernelY)
{
    const Size turned{size.height, size.width};
    return transpose(
        convolveRows(transpose(convolveRows(in, size, kernelX), size), turned, kernelY), turned);
}

template <class Function> std::vector<double> tabulate(int radius, Function f)
{
    std::vector<double> kernel;
    for (int i = -radius; i <= radius; ++i)
        kernel.push_back(f(static_cast<double>(i)));
    return kernel;
}

double sumOf(const std::vector<double>& v)
{
    double sum = 0.0;
    for (const double x : v)
        sum += x;
    return sum;
}

// One term of a contrast sensitivity function: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Sensitivity
{
    double a;
    double b;
};
constexpr std::array<Sensitivity, 1> kAchromatic = {{{1.0, 0.0047}}};
constexpr std::array<Sensitivity, 1> kRedGreen = {{{1.0, 0.0053}}};
constexpr std::array<Sensitivity, 2> kBlueYellow = {{{34.1, 0.04}, {13.5, 0.025}}};

// Filters by the sum of the terms, scaled so that the whole kernel sums to one. Each term is
// separable.
Plane filterBySensitivity(const Plane& in, Size size, std::span<const Sensitivity> terms,
                          double pixelsPerDegree)
{
    const double widest = std::sqrt(kBlueYellow[0].b / (2.0 * kPi * kPi));
    const int radius = static_cast<int>(std::ceil(3.0 * widest * pixelsPerDegree));
    Plane out(in.size(), 0.0);
    double total = 0.0;
    for (const Sensitivity& term : terms) {
        const auto kernel = tabulate(radius, [&](double i) {
            const double d = i / pixelsPerDegree;
            return std::exp(-kPi * kPi * d * d / term.b);
        });
        const double weight = term.a * std::sqrt(kPi / term.b);
        total += weight * sumOf(kernel) * sumOf(kernel);
        const Plane part = convolve(in, size, kernel, kernel);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] += weight * part[i];
    }
    for (double& value : out)
        value /= total;
    return out;
}

// The linear opponent space Y Cx Cz.
std::array<Plane, 3> opponentPlanes(const CpuImage& image)
{
    std::array<Plane, 3> planes;
    for (const glm::vec4& pixel : image.pixels) {
        const glm::dvec3 rgb(glm::clamp(glm::vec3(pixel), 0.0f, 1.0f));
        const glm::dvec3 xyz = relativeXyzFromRgb(rgb);
        planes[0].push_back(116.0 * xyz.y - 16.0);
        planes[1].push_back(500.0 * (xyz.x - xyz.y));
        planes[2].push_back(200.0 * (xyz.y - xyz.z));
    }
    return planes;
}

// CIELAB with chroma scaled by lightness: saturated dark colours look less different (Hunt effect).
glm::dvec3 huntLab(glm::dvec3 rgb)
{
    const glm::dvec3 lab = labFromRgb(rgb);
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

// Hybrid distance: city block between lightness and chroma plane.
double hyAb(glm::dvec3 a, glm::dvec3 b)
{
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// What the eye keeps of the picture at this distance, in Hunt-adjusted Lab.
std::vector<glm::dvec3> perceivedColours(const std::array<Plane, 3>& opponent, Size size,
                                         double pixelsPerDegree)
{
    const Plane y = filterBySensitivity(opponent[0], size, kAchromatic, pixelsPerDegree);
    const Plane cx = filterBySensitivity(opponent[1], size, kRedGreen, pixelsPerDegree);
    const Plane cz = filterBySensitivity(opponent[2], size, kBlueYellow, pixelsPerDegree);
    std::vector<glm::dvec3> colours(size.count());
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const double luminance = (y[i] + 16.0) / 116.0;
        const glm::dvec3 xyz(luminance + cx[i] / 500.0, luminance, luminance - cz[i] / 200.0);
        colours[i] = huntLab(glm::clamp(rgbFromRelativeXyz(xyz), 0.0, 1.0));
    }
    return colours;
}

// Compresses large differences: the range up to kPc of the maximum takes kPt of [0,1].
double redistribute(double difference)
{
    static const double largest =
        std::pow(hyAb(huntLab({0.0, 1.0, 0.0}), huntLab({0.0, 0.0, 1.0})), kQc);
    const double knee = kPc * largest;
    const double value = std::pow(difference, kQc);
    if (value < knee)
        return value * kPt / knee;
    return std::min(1.0, kPt + (value - knee) / (largest - knee) * (1.0 - kPt));
}

// Positive and negative weights each sum to one in size.
std::vector<double> balance(std::vector<double> kernel)
{
    double positive = 0.0;
    double negative = 0.0;
    for (const double k : kernel)
        (k > 0.0 ? positive : negative) += std::abs(k);
    for (double& k : kernel)
        k /= k > 0.0 ? positive : negative;
    return kernel;
}

struct FeatureStrength
{
    Plane edges;
    Plane points;
};

// First and second Gaussian derivatives of the achromatic channel, magnitude over x and y.
FeatureStrength findFeatures(const Plane& achromatic, Size size, double pixelsPerDegree)
{
    const double deviation = 0.5 * kW * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    const auto gaussian = [&](double i) {
        return std::exp(-i * i / (2.0 * deviation * deviation));
    };
    std::vector<double> smooth = tabulate(radius, gaussian);
    const double sum = sumOf(smooth);
    for (double& k : smooth)
        k /= sum;
    const auto edge = balance(tabulate(radius, [&](double i) { return -i * gaussian(i); }));
    const auto point = balance(tabulate(
        radius, [&](double i) { return (i * i / (deviation * deviation) - 1.0) * gaussian(i); }));

    Plane grey(achromatic);
    for (double& value : grey)
        value = (value + 16.0) / 116.0;
    const auto magnitude = [&](const std::vector<double>& derivative) {
        const Plane x = convolve(grey, size, derivative, smooth);
        Plane y = convolve(grey, size, smooth, derivative);
        for (std::size_t i = 0; i < y.size(); ++i)
            y[i] = std::hypot(x[i], y[i]);
        return y;
    };
    return {magnitude(edge), magnitude(point)};
}

} // namespace

CpuImage computeFlip(const CpuImage& image, const CpuImage& reference, double pixelsPerDegree)
{
    if (image.width != reference.width || image.height != reference.height || image.pixels.empty())
        throw Error("FLIP: the pictures have " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " and " + std::to_string(reference.width) +
                    " x " + std::to_string(reference.height) + " pixels");
    for (const CpuImage* each : {&image, &reference})
        for (const glm::vec4& p : each->pixels)
            STRANDLIGHT_ASSERT(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));

    const Size size{static_cast<int>(image.width), static_cast<int>(image.height)};
    const std::array<Plane, 3> opponentA = opponentPlanes(image);
    const std::array<Plane, 3> opponentB = opponentPlanes(reference);
    const auto coloursA = perceivedColours(opponentA, size, pixelsPerDegree);
    const auto coloursB = perceivedColours(opponentB, size, pixelsPerDegree);
    const FeatureStrength featuresA = findFeatures(opponentA[0], size, pixelsPerDegree);
    const FeatureStrength featuresB = findFeatures(opponentB[0], size, pixelsPerDegree);

    CpuImage error(image.width, image.height);
    for (std::size_t i = 0; i < error.pixels.size(); ++i) {
        const double colour = redistribute(hyAb(coloursA[i], coloursB[i]));
        const double feature = std::max(std::abs(featuresA.edges[i] - featuresB.edges[i]),
                                        std::abs(featuresA.points[i] - featuresB.points[i]));
        const double amplified = std::pow(std::min(1.0, feature / std::sqrt(2.0)), kQf);
        const auto flip = static_cast<float>(std::pow(colour, 1.0 - amplified));
        error.pixels[i] = glm::vec4(flip, flip, flip, 1.0f);
    }
    return error;
}

} // namespace strandlight
