// Linear sRGB, CIE XYZ (relative to white) and CIELAB. IEC 61966-2-1; CIE 15:2004. White is RGB (1,
// 1, 1).
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace strandlight {

// Columns: XYZ of the red, green and blue primary.
inline const glm::dmat3 kXyzFromRgb(0.4123907993, 0.2126390059, 0.0193308187, 0.3575843394,
                                    0.7151686788, 0.1191947798, 0.1804807884, 0.0721923154,
                                    0.9505321522);

// XYZ divided by that of white: each component is 1 for white.
inline glm::dvec3 relativeXyzFromRgb(glm::dvec3 rgb)
{
    static const glm::dvec3 white = kXyzFromRgb * glm::dvec3(1.0);
    return kXyzFromRgb * rgb / white;
}

inline glm::dvec3 rgbFromRelativeXyz(glm::dvec3 xyz)
{
    static const glm::dvec3 white = kXyzFromRgb * glm::dvec3(1.0);
    static const glm::dmat3 inverse = glm::inverse(kXyzFromRgb);
    return inverse * (xyz * white);
}

inline glm::dvec3 labFromRgb(glm::dvec3 rgb)
{
    constexpr double kDelta = 6.0 / 29.0;
    const auto f = [](double t) {
        return t > kDelta * kDelta * kDelta ? std::cbrt(t)
                                            : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    };
    const glm::dvec3 xyz = relativeXyzFromRgb(rgb);
    const double y = f(xyz.y);
    return {116.0 * y - 16.0, 500.0 * (f(xyz.x) - y), 200.0 * (y - f(xyz.z))};
}

// May leave [0,1]: not every Lab colour is an sRGB colour.
inline glm::dvec3 rgbFromLab(glm::dvec3 lab)
{
    constexpr double kDelta = 6.0 / 29.0;
    const auto inverseF = [](double t) {
        return t > kDelta ? t * t * t : 3.0 * kDelta * kDelta * (t - 4.0 / 29.0);
    };
    const double y = (lab.x + 16.0) / 116.0;
    return rgbFromRelativeXyz(
        {inverseF(y + lab.y / 500.0), inverseF(y), inverseF(y - lab.z / 200.0)});
}

} // namespace strandlight
