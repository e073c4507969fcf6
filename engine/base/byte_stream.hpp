// Little-endian values into and out of byte arrays, every read checked against what is left.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/base/error.hpp"

namespace strandlight {

static_assert(std::endian::native == std::endian::little,
              "files are little-endian and copied as they are");

class ByteWriter
{
public:
    template <class T> void value(const T& v)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&v, sizeof(T));
    }
    // u64 count, then the elements.
    template <class T> void array(const std::vector<T>& values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        value(std::uint64_t(values.size()));
        append(values.data(), values.size() * sizeof(T));
    }
    void text(const std::string& s) { array(std::vector<char>(s.begin(), s.end())); }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

private:
    void append(const void* from, std::size_t count)
    {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + count);
        if (count)
            std::memcpy(bytes_.data() + at, from, count);
    }

    std::vector<std::uint8_t> bytes_;
};

class ByteReader
{
public:
    // `path` names the file in errors.
    ByteReader(std::span<const std::uint8_t> bytes, std::string path)
        : bytes_(bytes), path_(std::move(path))
    {
    }

    template <class T> T value()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        T v;
        std::memcpy(&v, take(sizeof(T)), sizeof(T));
        return v;
    }
    template <class T> std::vector<T> array()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto count = value<std::uint64_t>();
        if (count > left() / sizeof(T)) // before anything is allocated
            fail(std::to_string(count) + " elements are claimed, " + std::to_string(left()) +
                 " bytes are left");
        std::vector<T> values(count);
        if (count)
            std::memcpy(values.data(), take(count * sizeof(T)), count * sizeof(T));
        return values;
    }
    std::string text()
    {
        const std::vector<char> s = array<char>();
        return {s.begin(), s.end()};
    }
    std::size_t left() const { return bytes_.size() - at_; }
    [[noreturn]] void fail(const std::string& reason) const
    {
        throw FileError(path_, "byte " + std::to_string(at_), reason);
    }

private:
    const std::uint8_t* take(std::size_t count)
    {
        if (count > left())
            fail("the file ends too early: " + std::to_string(count) + " bytes are needed, " +
                 std::to_string(left()) + " are left");
        const std::uint8_t* from = bytes_.data() + at_;
        at_ += count;
        return from;
    }

    std::span<const std::uint8_t> bytes_;
    std::string path_;
    std::size_t at_ = 0;
};

} // namespace strandlight
