// Spherical gaussians in double, by formulas that share nothing with the fp32 ones, and by
// quadrature.
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace strandlight::reference {

inline constexpr double kPi64 = 3.14159265358979323846;

// ln of exp(lambda (cos - 1)); the axes are normalised first.
inline double sgLogValue(glm::dvec3 d, glm::dvec3 axis, double lambda)
{
    const glm::dvec3 chord = glm::normalize(d) - glm::normalize(axis);
    return -0.5 * lambda * glm::dot(chord, chord);
}

inline double sgIntegral(double lambda)
{
    return lambda == 0.0 ? 4.0 * kPi64 : 2.0 * kPi64 * -std::expm1(-2.0 * lambda) / lambda;
}

// ln of the integral of G1 G2: both exponents added at the product's own axis.
inline double sgLogInnerProduct(glm::dvec3 axis1, double lambda1, glm::dvec3 axis2, double lambda2)
{
    const glm::dvec3 sum = glm::normalize(axis1) * lambda1 + glm::normalize(axis2) * lambda2;
    const double lambda = glm::length(sum);
    const glm::dvec3 chord = glm::normalize(axis1) - glm::normalize(axis2);
    const double total = lambda1 + lambda2;
    // lambda - total, by the difference of squares
    const double peak =
        total > 0.0 ? -lambda1 * lambda2 * glm::dot(chord, chord) / (lambda + total) : 0.0;
    return peak + std::log(sgIntegral(lambda));
}

// Integrals over the hemisphere about the normal of exp(lambda (cos - 1)), plain and times the
// cosine to the normal; `cosine` is the axis' own. Quadrature along the angle from the axis, the
// turn about it in closed form: absolute error below 1e-9 of the lobe's integral.
struct SgHemisphere
{
    double plain;
    double cosineWeighted;
};
SgHemisphere sgHemisphere(double lambda, double cosine);

// coth(lambda) - 1 / lambda, and its inverse by bisection.
double sgMeanLength(double lambda);
double sgSharpness(double meanLength);

} // namespace strandlight::reference
