// FNV-1a, 64 bits, over raw bytes: names an input, protects nothing.
// Fowler, Noll, Vo. The FNV Non-Cryptographic Hash Algorithm. 1991
#pragma once

#include <cstddef>
#include <cstdint>

namespace strandlight {

class Fnv1a
{
public:
    void bytes(const void* data, std::size_t count)
    {
        const auto* raw = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < count; ++i)
            value_ = (value_ ^ raw[i]) * 0x100000001B3ull;
    }
    template <class T> void value(const T& v) { bytes(&v, sizeof(T)); } // T without padding
    std::uint64_t result() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325ull;
};

} // namespace strandlight
