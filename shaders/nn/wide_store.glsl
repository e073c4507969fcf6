// Floats as 64-bit values, of which one store takes eight: a CPU device stores a vector lane by lane, and the turn of that
// loop costs more than what it stores. Include it before any declaration.
#ifndef STRANDLIGHT_NN_WIDE_STORE_GLSL
#define STRANDLIGHT_NN_WIDE_STORE_GLSL

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

u64vec4 asPairs(vec4 left, vec4 right)
{
    uvec4 l = floatBitsToUint(left), r = floatBitsToUint(right);
    return u64vec4(packUint2x32(l.xy), packUint2x32(l.zw), packUint2x32(r.xy), packUint2x32(r.zw));
}

#endif
