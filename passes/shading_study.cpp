#include "passes/shading_study.hpp"

#include <algorithm>
#include <cmath>

#include "passes/specular_lut.hpp"
#include "shaders/shared/sg_diffuse.h"
#include "shaders/shared/sg_specular.h"

namespace strandlight {
namespace {

// exp(-|x|) I0(x); the azimuthal integral of a lobe is 2 pi exp(..) I0(..).
double scaledBesselI0(double x)
{
    x = std::abs(x);
    if (x < 15.0)
        return std::cyl_bessel_i(0.0, x) * std::exp(-x);
    double term = 1.0;
    double sum = 1.0;
    for (int k = 1; k < 40; ++k) {
        const double ratio = (2.0 * k - 1.0) * (2.0 * k - 1.0) / (k * 8.0 * x);
        if (ratio >= 1.0)
            break;
        term *= ratio;
        sum += term;
    }
    return sum / std::sqrt(2.0 * M_PI * x);
}

} // namespace

GgxQuadrature::GgxQuadrature(double alpha, double cosView)
{
    constexpr int kRadial = 128;
    constexpr int kAzimuth = 128;
    const double a2 = alpha * alpha;
    const glm::dvec3 view(std::sqrt(1.0 - cosView * cosView), 0.0, cosView);
    for (int i = 0; i < kRadial; ++i)
        for (int j = 0; j < kAzimuth; ++j) {
            const double t = (i + 0.5) / kRadial;
            const double u = 1.0 - (1.0 - t) * (1.0 - t);
            const double phi = 2.0 * M_PI * (j + 0.5) / kAzimuth;
            const double c = std::sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u));
            const double s = std::sqrt(1.0 - c * c);
            const glm::dvec3 h(s * std::cos(phi), s * std::sin(phi), c);
            const double vh = glm::dot(view, h);
            const glm::dvec3 l = h * (2.0 * vh) - view;
            if (vh <= 0.0 || l.z <= 0.0)
                continue;
            const double visibility = 0.5 / (l.z * std::sqrt(a2 + (1.0 - a2) * cosView * cosView) +
                                             cosView * std::sqrt(a2 + (1.0 - a2) * l.z * l.z));
            directions.push_back(l);
            weights.push_back(visibility * l.z * 4.0 * vh / c * 2.0 * (1.0 - t) /
                              (kRadial * kAzimuth));
            schlick.push_back(std::pow(1.0 - vh, 5.0));
        }
}

double GgxQuadrature::reflect(const glm::dvec3& axis, double sharpness, double f0) const
{
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const glm::dvec3 chord = directions[i] - axis;
        const double fresnel = f0 + (1.0 - f0) * schlick[i];
        sum += fresnel * weights[i] * std::exp(-0.5 * sharpness * glm::dot(chord, chord));
    }
    return sum;
}

SpecularErrors& SpecularErrors::operator+=(const SpecularErrors& other)
{
    reference += other.reference;
    asg += other.asg;
    ndf += other.ndf;
    mixture += other.mixture;
    dielectricReference += other.dielectricReference;
    dielectric += other.dielectric;
    return *this;
}

SpecularErrors specularErrors(double alpha, double cosView, double sharpness, std::uint32_t axes)
{
    const GgxQuadrature quadrature(alpha, cosView);
    const glm::vec3 normal(0.0f, 0.0f, 1.0f);
    const glm::vec3 view(float(std::sqrt(1.0 - cosView * cosView)), 0.0f, float(cosView));
    const auto a = float(alpha), l = float(sharpness);
    const gpu::SgMixture mixture = specularTable().mixture(a, normal, view);
    SpecularErrors sums;
    for (std::uint32_t i = 0; i < axes; ++i) {
        const double z = 1.0 - 1.2 * (i + 0.5) / axes;
        const double r = std::sqrt(1.0 - z * z);
        const glm::dvec3 axis(r * std::cos(i * 2.399963), r * std::sin(i * 2.399963), z);
        const glm::vec3 light(axis);
        const double exact = quadrature.reflect(axis, sharpness);
        sums.reference += exact;
        sums.asg += std::abs(double(gpu::sgSpecularAsg(a, normal, view, light, l)) - exact);
        sums.ndf += std::abs(double(gpu::sgSpecularNdfFilter(a, normal, view, light, l)) - exact);
        const glm::dvec2 ours(gpu::sgSpecularMixture(mixture, normal, view, light, l));
        sums.mixture += std::abs(ours.x + ours.y - exact);
        const double dielectric = quadrature.reflect(axis, sharpness, 0.04);
        sums.dielectricReference += dielectric;
        sums.dielectric += std::abs(0.04 * ours.x + ours.y - dielectric);
    }
    return sums;
}

SpecularErrors specularErrors(double alpha, double sharpness)
{
    SpecularErrors sums;
    for (const double degrees : {0.0, 30.0, 60.0, 80.0})
        sums += specularErrors(alpha, std::cos(degrees * M_PI / 180.0), sharpness, 60);
    return sums;
}

// Midpoint rule in the polar angle, panels gathered around the lobe's own angle so that sharp lobes
// are resolved.
double hemisphereQuadrature(double sharpness, double cosine, int power)
{
    const double axis = std::acos(cosine);
    const double sine = std::sin(axis);
    const double reach = 12.0 / std::sqrt(sharpness);
    const double low = std::max(0.0, axis - reach);
    const double high = std::min(M_PI / 2.0, axis + reach);
    if (low >= high)
        return 0.0;
    constexpr int kPanels = 1500;
    const double h = (high - low) / kPanels;
    double sum = 0.0;
    for (int i = 0; i < kPanels; ++i) {
        const double theta = low + h * (i + 0.5);
        const double z = std::cos(theta);
        const double r = std::sin(theta);
        const double exponent = sharpness * (std::cos(theta - axis) - 1.0); // = (c z + s r - 1)
        sum +=
            (power == 1 ? z : 1.0) * r * std::exp(exponent) * scaledBesselI0(sharpness * sine * r);
    }
    return 2.0 * M_PI * h * sum;
}

DiffuseErrors diffuseErrors(double sharpness)
{
    DiffuseErrors worst;
    const double energy = -2.0 * M_PI * std::expm1(-2.0 * sharpness) / sharpness;
    const auto l = float(sharpness);
    for (int i = 0; i <= 40; ++i) {
        const double cosine = std::clamp(-1.0 + 0.05 * i, -1.0, 1.0);
        const double exact = hemisphereQuadrature(sharpness, cosine, 1);
        const double half = hemisphereQuadrature(sharpness, cosine, 0);
        const auto c = float(cosine);
        // A value that is not finite must not pass for none.
        const auto raise = [&](double& slot, float value, double reference) {
            const double error = std::abs(double(value) - reference) / energy;
            slot = error > slot || !std::isfinite(error) ? error : slot;
        };
        raise(worst.tokuyoshi, gpu::sgIrradiance(l, c), exact);
        raise(worst.hill, gpu::sgIrradianceHill(l, c), exact);
        raise(worst.wang, gpu::sgIrradianceWang(l, c), exact);
        raise(worst.hemisphere, gpu::sgHemisphereIntegral(l, c), half);
    }
    return worst;
}

} // namespace strandlight
