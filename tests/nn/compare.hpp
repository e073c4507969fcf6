// How two arrays of numbers are compared, and random numbers to compare with.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "shaders/shared/rng.h"

namespace strandlight::test {

// |a - b| / |b| in the Euclidean norm; NaN anywhere gives NaN, which fails every "<=".
template <class A, class B> double relativeError(std::span<const A> a, std::span<const B> b)
{
    if (a.size() != b.size())
        return INFINITY;
    double difference = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference += (double(a[i]) - double(b[i])) * (double(a[i]) - double(b[i]));
        norm += double(b[i]) * double(b[i]);
    }
    return std::sqrt(difference) / std::max(std::sqrt(norm), 1e-30);
}
template <class A, class B> double relativeError(const std::vector<A>& a, const std::vector<B>& b)
{
    return relativeError(std::span<const A>(a), std::span<const B>(b));
}

inline bool sameBits(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Uniform in [low, high), a pure function of (seed, i); exact in fp32 and double alike.
template <class T>
std::vector<T> randomValues(std::size_t count, std::uint32_t seed, float low = -1.2f,
                            float high = 1.2f)
{
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = T(low + (high - low) * gpu::uniform3(std::uint32_t(i), 0, 0, seed).x);
    return values;
}

template <class To, class From> std::vector<To> convert(const std::vector<From>& from)
{
    return std::vector<To>(from.begin(), from.end());
}

} // namespace strandlight::test
