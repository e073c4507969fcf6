// Unsigned division without the instruction: on a CPU device it has no vector form and costs as much as a hundred multiply-adds.
#ifndef STRANDLIGHT_NN_DIVIDE_GLSL
#define STRANDLIGHT_NN_DIVIDE_GLSL

// a / b, exact for a < 2^31 and 0 < b < 2^31. The first quotient is off by at most a 2^-22, the second by one.
uint divide(uint a, uint b)
{
    float inverse = 1.0 / float(b);
    uint q = uint(float(a) * inverse);
    int rest = int(a - q * b);
    q += uint(int(floor(float(rest) * inverse)));
    rest = int(a - q * b);
    q -= rest < 0 ? 1u : 0u;
    q += rest >= int(b) ? 1u : 0u;
    return q;
}

#endif
