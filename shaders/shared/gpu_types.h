// Glue that lets one header be valid GLSL (scalar layout) and C++ (inside namespace strandlight::gpu).
//
//   #include "shaders/shared/gpu_types.h"     // C++;   GLSL: #include "shared/gpu_types.h"
//   STRANDLIGHT_SHARED_BEGIN
//   struct TonemapPush { float exposure; uint width; };
//   STRANDLIGHT_FN float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
//   STRANDLIGHT_SHARED_END
//
// Rules for shared functions: float literals carry an f (1.0f), no swizzles (v.x is fine), no global variables,
// out parameters as STRANDLIGHT_OUT(vec3) x / STRANDLIGHT_INOUT(vec3) x.
#ifndef STRANDLIGHT_SHARED_GPU_TYPES_H
#define STRANDLIGHT_SHARED_GPU_TYPES_H

#ifdef __cplusplus
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
namespace strandlight::gpu {
using namespace glm;
using uint = std::uint32_t;
inline float uintBitsToFloat(uint v) { return glm::uintBitsToFloat(v); }
inline uint floatBitsToUint(float v) { return glm::floatBitsToUint(v); }
} // namespace strandlight::gpu
#define STRANDLIGHT_SHARED_BEGIN namespace strandlight::gpu {
#define STRANDLIGHT_SHARED_END }
#define STRANDLIGHT_FN inline
#define STRANDLIGHT_OUT(type) type&
#define STRANDLIGHT_INOUT(type) type&
#define STRANDLIGHT_CONST(type) constexpr type
#else
#define STRANDLIGHT_SHARED_BEGIN
#define STRANDLIGHT_SHARED_END
#define STRANDLIGHT_FN
#define STRANDLIGHT_OUT(type) out type
#define STRANDLIGHT_INOUT(type) inout type
#define STRANDLIGHT_CONST(type) const type
#endif

#endif
