#include "engine/base/image_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/cie_lab.hpp"
#include "engine/base/error.hpp"
#include "engine/base/flip.hpp"
#include "engine/base/image_io.hpp"

namespace strandlight {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRelMseFloor = 0.01;

bool isFinite(glm::vec4 p)
{
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

void checkSizes(const CpuImage& image, const CpuImage& reference)
{
    if (image.width != reference.width || image.height != reference.height || image.pixels.empty())
        throw Error("cannot compare pictures of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " and " + std::to_string(reference.width) +
                    " x " + std::to_string(reference.height) + " pixels");
}

std::uint64_t countNonFinite(const CpuImage& image)
{
    return static_cast<std::uint64_t>(std::count_if(image.pixels.begin(), image.pixels.end(),
                                                    [](glm::vec4 p) { return !isFinite(p); }));
}

double sum3(glm::dvec3 v)
{
    return v.x + v.y + v.z;
}

void compareRadiance(const CpuImage& image, const CpuImage& reference, ImageComparison& result)
{
    double squares = 0.0;
    double relative = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (!isFinite(image.pixels[i]) || !isFinite(reference.pixels[i]))
            continue;
        const glm::dvec3 a(image.pixels[i]);
        const glm::dvec3 b(reference.pixels[i]);
        const glm::dvec3 d = (a - b) * (a - b);
        squares += sum3(d);
        relative += sum3(d / (b * b + kRelMseFloor));
        result.mean += a;
        result.referenceMean += b;
        count += 1.0;
    }
    const double scale = count > 0.0 ? 1.0 / count : std::numeric_limits<double>::quiet_NaN();
    result.mean *= scale;
    result.referenceMean *= scale;
    result.rmse = std::sqrt(squares * scale / 3.0);
    result.relMse = relative * scale / 3.0;
}

// Difference of the means of one block; false when it has no finite pixel.
bool blockDifference(const CpuImage& image, const CpuImage& reference, glm::uvec2 begin,
                     std::uint32_t side, glm::dvec3& difference)
{
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (std::uint32_t y = begin.y; y < std::min(begin.y + side, image.height); ++y) {
        for (std::uint32_t x = begin.x; x < std::min(begin.x + side, image.width); ++x) {
            if (!isFinite(image.at(x, y)) || !isFinite(reference.at(x, y)))
                continue;
            sum += glm::dvec3(image.at(x, y)) - glm::dvec3(reference.at(x, y));
            count += 1.0;
        }
    }
    difference = sum / std::max(count, 1.0);
    return count > 0.0;
}

double computeBlockRmse(const CpuImage& image, const CpuImage& reference, std::uint32_t side)
{
    double squares = 0.0;
    double count = 0.0;
    for (std::uint32_t y = 0; y < image.height; y += side) {
        for (std::uint32_t x = 0; x < image.width; x += side) {
            glm::dvec3 d(0.0);
            if (!blockDifference(image, reference, {x, y}, side, d))
                continue;
            squares += glm::dot(d, d);
            count += 3.0;
        }
    }
    return std::sqrt(squares / count);
}

double computePsnr(const CpuImage& image, const CpuImage& reference)
{
    double squares = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double d = static_cast<double>(encodeSrgb(image.pixels[i][c])) -
                             static_cast<double>(encodeSrgb(reference.pixels[i][c]));
            squares += d * d;
        }
    }
    const double mse = squares / (3.0 * static_cast<double>(image.pixels.size()));
    return mse > 0.0 ? -10.0 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

// Rec. 709 luma of the sRGB coded picture, in x.
CpuImage lumaImage(const CpuImage& display)
{
    CpuImage luma(display.width, display.height);
    for (std::size_t i = 0; i < luma.pixels.size(); ++i) {
        const glm::vec4& p = display.pixels[i];
        luma.pixels[i].x =
            0.2126f * encodeSrgb(p.x) + 0.7152f * encodeSrgb(p.y) + 0.0722f * encodeSrgb(p.z);
    }
    return luma;
}

std::vector<double> gaussianWindow(std::uint32_t size)
{
    constexpr double kDeviation = 1.5;
    std::vector<double> window(size);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < size; ++i) {
        const double d = i - 0.5 * (size - 1.0);
        window[i] = std::exp(-d * d / (2.0 * kDeviation * kDeviation));
        sum += window[i];
    }
    for (double& w : window)
        w /= sum;
    return window;
}

// Weighted first and second moments of a window of both pictures.
struct Moments
{
    double a = 0.0;
    double b = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    double ab = 0.0;

    void add(double w, const Moments& m)
    {
        a += w * m.a;
        b += w * m.b;
        aa += w * m.aa;
        bb += w * m.bb;
        ab += w * m.ab;
    }
};

double similarity(const Moments& m)
{
    constexpr double kC1 = 0.01 * 0.01;
    constexpr double kC2 = 0.03 * 0.03;
    const double varianceA = m.aa - m.a * m.a;
    const double varianceB = m.bb - m.b * m.b;
    const double covariance = m.ab - m.a * m.b;
    return (2.0 * m.a * m.b + kC1) * (2.0 * covariance + kC2) /
           ((m.a * m.a + m.b * m.b + kC1) * (varianceA + varianceB + kC2));
}

} // namespace

CpuImage displayImage(const CpuImage& image, float exposureStops)
{
    const float scale = std::exp2(exposureStops);
    CpuImage display(image.width, image.height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    for (std::size_t i = 0; i < display.pixels.size(); ++i)
        if (isFinite(image.pixels[i]))
            display.pixels[i] =
                glm::vec4(glm::clamp(glm::vec3(image.pixels[i]) * scale, 0.0f, 1.0f), 1.0f);
    return display;
}

double computeSsim(const CpuImage& image, const CpuImage& reference)
{
    checkSizes(image, reference);
    const std::vector<double> windowX = gaussianWindow(std::min(11u, image.width));
    const std::vector<double> windowY = gaussianWindow(std::min(11u, image.height));
    const auto columns = static_cast<std::uint32_t>(image.width - windowX.size() + 1);
    const auto rows = static_cast<std::uint32_t>(image.height - windowY.size() + 1);

    // Along x first: moments of row pieces, [height, columns].
    std::vector<Moments> pieces(std::size_t(image.height) * columns);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < columns; ++x) {
            for (std::uint32_t k = 0; k < windowX.size(); ++k) {
                const double a = image.at(x + k, y).x;
                const double b = reference.at(x + k, y).x;
                pieces[std::size_t(y) * columns + x].add(windowX[k], {a, b, a * a, b * b, a * b});
            }
        }
    }
    double sum = 0.0;
    for (std::uint32_t y = 0; y < rows; ++y) {
        for (std::uint32_t x = 0; x < columns; ++x) {
            Moments window;
            for (std::uint32_t k = 0; k < windowY.size(); ++k)
                window.add(windowY[k], pieces[std::size_t(y + k) * columns + x]);
            sum += similarity(window);
        }
    }
    return sum / (static_cast<double>(rows) * columns);
}

ImageComparison compareImages(const CpuImage& image, const CpuImage& reference,
                              const CompareSettings& settings)
{
    checkSizes(image, reference);
    if (settings.blockSide == 0)
        throw Error("cannot compare by blocks of 0 pixels");
    ImageComparison result;
    result.nonFinite = countNonFinite(image);
    result.referenceNonFinite = countNonFinite(reference);
    compareRadiance(image, reference, result);
    result.blockRmse = computeBlockRmse(image, reference, settings.blockSide);

    const CpuImage displayA = displayImage(image, settings.exposureStops);
    const CpuImage displayB = displayImage(reference, settings.exposureStops);
    result.psnr = computePsnr(displayA, displayB);
    result.ssim = computeSsim(lumaImage(displayA), lumaImage(displayB));
    const CpuImage flip = computeFlip(displayA, displayB);
    for (const glm::vec4& p : flip.pixels)
        result.flip += p.x;
    result.flip /= static_cast<double>(flip.pixels.size());
    return result;
}

// A path through CIELAB: L* from 2 to 97, hue from blue-violet over red to yellow, most chroma in
// the middle.
CpuImage heatmap(const CpuImage& error)
{
    CpuImage map(error.width, error.height);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const double value = error.pixels[i].x;
        if (!std::isfinite(value)) {
            map.pixels[i] =
                glm::vec4(error.pixels[i].x, 0.0f, 0.0f, 1.0f); // shown as broken by encodePng
            continue;
        }
        const double t = std::clamp(value, 0.0, 1.0);
        const double hue = (285.0 + 175.0 * t) * kPi / 180.0;
        const double chroma = 68.0 * std::sin(kPi * std::pow(t, 0.8)) + 20.0 * t;
        const glm::dvec3 lab(2.0 + 95.0 * t, chroma * std::cos(hue), chroma * std::sin(hue));
        map.pixels[i] = glm::vec4(glm::clamp(glm::vec3(rgbFromLab(lab)), 0.0f, 1.0f), 1.0f);
    }
    return map;
}

} // namespace strandlight
