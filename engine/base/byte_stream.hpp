// Little-endian values into and out of byte arrays, every read checked against what is left.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

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
    void text(const std::string& s); // u32 count, then the characters
    // Room for `count` bytes at the end; valid until the next call.
    std::span<std::uint8_t> extend(std::size_t count)
    {
        bytes_.resize(bytes_.size() + count);
        return std::span(bytes_).last(count);
    }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }
    std::vector<std::uint8_t> take() { return std::move(bytes_); }

private:
    void append(const void* from, std::size_t count);

    std::vector<std::uint8_t> bytes_;
};

class ByteReader
{
public:
    // For errors: `path` is the file, `place` the part of it that these bytes are ("": the byte's
    // position is named instead).
    ByteReader(std::span<const std::uint8_t> bytes, std::string path, std::string place = {})
        : bytes_(bytes), path_(std::move(path)), place_(std::move(place))
    {
    }

    template <class T> T value()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        T v;
        std::memcpy(&v, take(sizeof(T)).data(), sizeof(T));
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
        if (count != 0)
            std::memcpy(values.data(), take(count * sizeof(T)).data(), count * sizeof(T));
        return values;
    }
    std::string text(std::uint32_t longest);
    std::span<const std::uint8_t> take(std::uint64_t count);
    std::uint64_t left() const { return bytes_.size() - at_; }
    std::uint64_t size() const { return bytes_.size(); }
    void seek(std::uint64_t position);
    void finish() const; // fails when anything follows
    [[noreturn]] void fail(const std::string& reason) const;

private:
    std::span<const std::uint8_t> bytes_;
    std::string path_;
    std::string place_;
    std::uint64_t at_ = 0;
};

} // namespace strandlight
