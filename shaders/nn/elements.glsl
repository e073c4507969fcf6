// What elements of a tensor are stored as: floats, or halves in the variants of a kernel that say so. Sums are floats
// always. Include it before any declaration. A kernel that defines GUARD_BINDING reports magnitudes that no half holds.
#ifndef STRANDLIGHT_NN_ELEMENTS_GLSL
#define STRANDLIGHT_NN_ELEMENTS_GLSL

#ifdef SOURCE_HALF
#define SOURCE_TEXEL r16f
#define SOURCE_QUAD rgba16f
#else
#define SOURCE_TEXEL r32f
#define SOURCE_QUAD rgba32f
#endif

#ifdef RESULT_HALF
#extension GL_EXT_shader_16bit_storage : require
#define RESULT_ELEMENT float16_t
#define RESULT_QUAD f16vec4
#else
#define RESULT_ELEMENT float
#define RESULT_QUAD vec4
#endif

#if defined(RESULT_HALF) && defined(GUARD_BINDING)
layout(binding = GUARD_BINDING, scalar) buffer Guard { uint largestRefused; }; // bits of a float (compute_nn/half_guard.hpp)
const uint kLargestHalf = 0x477fe000u;                                         // of 65504
uint largestStored = 0u;

float guarded(float value)
{
    largestStored = max(largestStored, floatBitsToUint(value) & 0x7fffffffu);
    return value;
}
vec4 guarded(vec4 value)
{
    uvec4 bits = floatBitsToUint(value) & 0x7fffffffu;
    largestStored = max(largestStored, max(max(bits.x, bits.y), max(bits.z, bits.w)));
    return value;
}
void reportLargest() // at the end of main
{
    if (largestStored > kLargestHalf)
        atomicMax(largestRefused, largestStored);
}
#else
float guarded(float value) { return value; }
vec4 guarded(vec4 value) { return value; }
void reportLargest() {}
#endif

#endif
