#include "passes/stress/reference.hpp"

#include <algorithm>
#include <array>

namespace strandlight::reference {

namespace {

// Gauss-Legendre, 16 points on [-1, 1], one half of the symmetric set. Abramowitz, Stegun. 1964
// (25.4.30)
constexpr std::array<double, 8> kNodes = {
    0.0950125098376374, 0.2816035507792589, 0.4580167776572274, 0.6178762444026438,
    0.7554044083550030, 0.8656312023878318, 0.9445750230732326, 0.9894009349916499};
constexpr std::array<double, 8> kWeights = {
    0.1894506104550685, 0.1826034150449236, 0.1691565193950025, 0.1495959888165767,
    0.1246289712555339, 0.0951585116824928, 0.0622535239386479, 0.0271524594117541};

template <class Function> glm::dvec2 integrate(double low, double high, Function f)
{
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    glm::dvec2 sum(0.0);
    for (std::size_t i = 0; i < kNodes.size(); ++i)
        sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
    return sum * half;
}

} // namespace

SgHemisphere sgHemisphere(double lambda, double cosine)
{
    const double c = std::clamp(cosine, -1.0, 1.0);
    const double s = std::sqrt((1.0 - c) * (1.0 + c));
    const auto ring = [&](double angle) {
        // On the ring the cosine to the normal is a + b cos(psi).
        const double a = c * std::cos(angle), b = s * std::sin(angle);
        const double half = std::sin(0.5 * angle);
        const double weight = std::exp(-2.0 * lambda * half * half) * std::sin(angle);
        if (a >= b)
            return glm::dvec2(2.0 * kPi64, 2.0 * kPi64 * a) * weight;
        if (a <= -b)
            return glm::dvec2(0.0);
        const double edge = std::acos(std::clamp(-a / b, -1.0, 1.0));
        return glm::dvec2(2.0 * edge, 2.0 * (a * edge + b * std::sin(edge))) * weight;
    };
    // The ring's share has corners where the ring touches the horizon. Near them it goes with a
    // square root, which the substitution t^2 (3 - 2 t), flat at both ends, makes smooth.
    const double horizon = std::abs(std::asin(c));
    const double width = std::min(kPi64, 9.0 / std::sqrt(std::max(lambda, 1e-6)));
    std::array<double, 8> cuts = {0.0,          horizon,     kPi64 - horizon, 0.1 * width,
                                  0.25 * width, 0.5 * width, width,           kPi64};
    std::sort(cuts.begin(), cuts.end());
    glm::dvec2 sum(0.0);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double length = cuts[i + 1] - cuts[i];
        if (length > 0.0)
            sum += integrate(0.0, 1.0, [&](double t) {
                return ring(cuts[i] + length * t * t * (3.0 - 2.0 * t)) *
                       (6.0 * t * (1.0 - t) * length);
            });
    }
    return {sum.x, sum.y};
}

double sgMeanLength(double lambda)
{
    if (lambda < 1e-2)
        return lambda / 3.0 - lambda * lambda * lambda / 45.0;
    return 1.0 / std::tanh(lambda) - 1.0 / lambda;
}

double sgSharpness(double meanLength)
{
    if (meanLength < 1e-9)
        return 3.0 * meanLength;
    double low = 1e-9, high = 1e12;
    for (int i = 0; i < 100; ++i) {
        const double middle = std::sqrt(low * high);
        (sgMeanLength(middle) < meanLength ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

} // namespace strandlight::reference
