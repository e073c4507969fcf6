// The shared closed forms compiled once more with `float` meaning double. The headers' own rules
// make that possible: no swizzles, no globals, every type by its GLSL name.
#include "passes/stress/closed_forms_double.hpp"

#include <cmath>

namespace strandlight::gpu_double {

using namespace glm;
using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
// Literals stay floats, which glm's templates would not mix with doubles.
inline double max(double a, double b)
{
    return a < b ? b : a;
}
inline double min(double a, double b)
{
    return b < a ? b : a;
}
inline double clamp(double x, double low, double high)
{
    return min(max(x, low), high);
}
inline double mix(double a, double b, double t)
{
    return a * (1.0 - t) + b * t;
}

} // namespace strandlight::gpu_double

#define STRANDLIGHT_SHARED_GPU_TYPES_H // the types above instead
#define STRANDLIGHT_SHARED_BEGIN namespace strandlight::gpu_double {
#define STRANDLIGHT_SHARED_END }
#define STRANDLIGHT_FN inline
#define STRANDLIGHT_OUT(type) type&
#define STRANDLIGHT_INOUT(type) type&
#define STRANDLIGHT_CONST(type) constexpr type
#define float double
#include "shaders/shared/stress_functions.h"
#undef float

namespace strandlight {

StressOutputDouble stressInDouble(std::uint32_t function, const std::array<glm::vec4, 4>& item)
{
    const gpu_double::StressOutput result =
        gpu_double::stressFunction(function, {glm::dvec4(item[0]), glm::dvec4(item[1]),
                                              glm::dvec4(item[2]), glm::dvec4(item[3])});
    return {result.x, result.y};
}

} // namespace strandlight
