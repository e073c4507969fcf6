// Elementary functions with a known error. lavapipe's own log is wrong in the fourth digit near 1 and its exp in the
// sixth for large arguments; these stay within 4e-7 relative everywhere. NaN passes through.
#ifndef STRANDLIGHT_NN_MATH_GLSL
#define STRANDLIGHT_NN_MATH_GLSL

#include "shared/nan_bits.h"

// e^x as 2^k e^r, |r| <= ln(2)/2, Taylor to the sixth power. 0 below -87, infinity above 88.7.
float nnExp(float x)
{
    float limited = x > 88.8 ? 88.8 : (x < -88.0 ? -88.0 : x);
    float k = floor(limited * 1.4426950408889634 + 0.5);
    precise float high = limited - k * 0.693359375;     // ln 2 in two parts: the first has trailing zeros,
    precise float r = high + k * 2.12194440054690583e-4; // so the product with k is exact
    float p = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0))))));
    // Two factors: 2^k alone leaves the range for k = 128.
    int half0 = int(k) >> 1;
    int half1 = int(k) - half0;
    float value = p * uintBitsToFloat(uint(half0 + 127) << 23) * uintBitsToFloat(uint(half1 + 127) << 23);
    value = x < -87.0 ? 0.0 : value;
    value = x > 88.7 ? uintBitsToFloat(0x7f800000u) : value;
    return keepNan(x, value);
}

// 2^y for y <= 0: exactly 1 at 0, minimax of degree 5 on [-1/2, 1/2], within 2.3e-7. 0 below -100: what it weights must not
// become denormal, which a CPU device computes a hundred times slower. NaN passes through.
const float kLog2E = 1.4426950408889634;
const float kExp2C1 = 0.6931469670639855, kExp2C2 = 0.24022119722727053, kExp2C3 = 0.05550713274200602;
const float kExp2C4 = 0.009675541396042944, kExp2C5 = 0.0013276471945264257;
// Of four or eight at once, each step of all before the next: alone it is a chain of a dozen operations that wait for each
// other, and a CPU's scheduler holds no more than two of them.
vec4 exp2Scaled(vec4 y, vec4 shifted, vec4 p)
{
    vec4 value = p * uintBitsToFloat((floatBitsToUint(shifted) << 23) + 0x3f800000u);
    // Whether y is in [-infinity, -100), by its bits: no NaN is.
    bvec4 tiny = lessThanEqual(floatBitsToUint(y) - 0xc2c80001u, uvec4(0xff800000u - 0xc2c80001u));
    return mix(value, vec4(0.0), tiny);
}
vec4 nnExp2Negative(vec4 y)
{
    precise vec4 shifted = y + 12582912.0; // 1.5 * 2^23: the nearest integer is in the lowest bits
    precise vec4 k = shifted - 12582912.0;
    vec4 f = y - k;
    vec4 p = 1.0 + f * (kExp2C1 + f * (kExp2C2 + f * (kExp2C3 + f * (kExp2C4 + f * kExp2C5))));
    return exp2Scaled(y, shifted, p);
}
void hornerStep(vec4 f[2], float c, inout vec4 p[2])
{
    p[0] = c + f[0] * p[0];
    p[1] = c + f[1] * p[1];
}
void nnExp2Negative(inout vec4 y[2])
{
    precise vec4 shifted0 = y[0] + 12582912.0, shifted1 = y[1] + 12582912.0;
    precise vec4 k0 = shifted0 - 12582912.0, k1 = shifted1 - 12582912.0;
    vec4 f[2] = vec4[2](y[0] - k0, y[1] - k1);
    vec4 p[2] = vec4[2](vec4(kExp2C5), vec4(kExp2C5));
    hornerStep(f, kExp2C4, p);
    hornerStep(f, kExp2C3, p);
    hornerStep(f, kExp2C2, p);
    hornerStep(f, kExp2C1, p);
    hornerStep(f, 1.0, p);
    y[0] = exp2Scaled(y[0], shifted0, p[0]);
    y[1] = exp2Scaled(y[1], shifted1, p[1]);
}

// ln(1 + x) for x >= 0: 1 + x = 2^k (1 + f), ln(1 + f) = 2 atanh(f / (2 + f)). For k = 0, f is x itself, so what the sum
// 1 + x rounds away matters only where the logarithm is above 0.34.
float nnLog1p(float x)
{
    uint bits = floatBitsToUint(1.0 + x);
    uint k = ((bits + 0x004afb0du) >> 23) - 127u; // 1 + f in [sqrt(1/2), sqrt(2))
    float f = k == 0u ? x : uintBitsToFloat(bits - (k << 23)) - 1.0;
    float s = f / (2.0 + f);
    float z = s * s;
    float series = 2.0 * s * (1.0 + z * (1.0 / 3.0 + z * (0.2 + z * (1.0 / 7.0 + z * (1.0 / 9.0 + z * (1.0 / 11.0))))));
    float value = float(k) * 0.69314718055994531 + series;
    return (bits & 0x7f800000u) == 0x7f800000u ? x : value;
}

// max(x, 0) that keeps NaN.
float nnPositive(float x)
{
    return keepNan(x, x > 0.0 ? x : 0.0);
}

float nnSoftplus(float x)
{
    return (x > 0.0 ? x : 0.0) + nnLog1p(nnExp(-abs(x)));
}

float nnSigmoid(float x)
{
    float e = nnExp(-abs(x));
    return (x < 0.0 ? e : 1.0) / (1.0 + e);
}

// 1 - e^-y for y >= 0: the derivative of softplus in terms of its value.
float nnOneMinusExp(float y)
{
    float series = y * (1.0 - y * (0.5 - y * (1.0 / 6.0 - y * (1.0 / 24.0 - y * (1.0 / 120.0)))));
    return y < 0.1 ? series : 1.0 - nnExp(-y);
}

#endif
