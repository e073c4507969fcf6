// The closed forms of shading against quadrature in double: how wrong each tier is.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace strandlight {

// Directions and weights of one GGX slice (n = z, view in the xz plane), F = 1: sum of weight
// g(direction) is the radiance reflected under illumination g. 128 x 128 points, by importance.
// Walter, Marschner, Li, Torrance. Microfacet Models for Refraction through Rough Surfaces. 2007
struct GgxQuadrature
{
    std::vector<glm::dvec3> directions;
    std::vector<double> weights;
    std::vector<double> schlick; // (1 - v.h)^5

    GgxQuadrature(double alpha, double cosView);
    // Of a unit lobe under Schlick's Fresnel term from f0 to 1.
    double reflect(const glm::dvec3& axis, double sharpness, double f0 = 1.0) const;
};

// Sums over light axes of |closed form - quadrature| and of the quadrature.
struct SpecularErrors
{
    double reference = 0.0; // f0 = 1
    double asg = 0.0;
    double ndf = 0.0;
    double mixture = 0.0;
    double dielectricReference = 0.0; // f0 = 0.04
    double dielectric = 0.0;          // mixture

    SpecularErrors& operator+=(const SpecularErrors& other);
};

// `axes` Fibonacci light axes from the normal to 12 degrees below the horizon.
SpecularErrors specularErrors(double alpha, double cosView, double sharpness, std::uint32_t axes);
// The same over views of 0, 30, 60 and 80 degrees from the normal, 60 axes each.
SpecularErrors specularErrors(double alpha, double sharpness);

// Integral over the hemisphere of a unit lobe times cos^power; power 0 or 1, sharpness > 0.
double hemisphereQuadrature(double sharpness, double cosine, int power);

// Largest |closed form - quadrature| over 41 cosines from -1 to 1, as a share of the lobe's energy.
struct DiffuseErrors
{
    double tokuyoshi = 0.0;
    double hill = 0.0;
    double wang = 0.0;
    double hemisphere = 0.0; // of the plain hemisphere integral
};
DiffuseErrors diffuseErrors(double sharpness);

} // namespace strandlight
