// Little-endian values in and out of byte arrays, every read checked.
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

static_assert(std::endian::native == std::endian::little, "values are copied as they are");

class ByteWriter
{
public:
    template <class T> void write(const T& value)
    {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
        bytes_.insert(bytes_.end(), begin, begin + sizeof(T));
    }

    void writeString(const std::string& text)
    {
        write(static_cast<std::uint32_t>(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }

    // Room for `count` bytes at the end; valid until the next call.
    std::span<std::uint8_t> extend(std::size_t count)
    {
        bytes_.resize(bytes_.size() + count);
        return std::span(bytes_).last(count);
    }

    std::vector<std::uint8_t> take() { return std::move(bytes_); }

private:
    std::vector<std::uint8_t> bytes_;
};

// `name` is the file, `place` the part of it that these bytes are.
class ByteReader
{
public:
    ByteReader(std::span<const std::uint8_t> bytes, std::string name, std::string place)
        : bytes_(bytes), name_(std::move(name)), place_(std::move(place))
    {
    }

    [[noreturn]] void fail(const std::string& reason) const
    {
        throw FileError(name_, place_, reason);
    }

    std::span<const std::uint8_t> take(std::uint64_t count)
    {
        if (count > bytes_.size() - position_)
            fail("ends at byte " + std::to_string(bytes_.size()) + ", " + std::to_string(count) +
                 " bytes are needed from byte " + std::to_string(position_));
        const auto part = bytes_.subspan(position_, count);
        position_ += count;
        return part;
    }

    template <class T> T read()
    {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }

    std::string readString(std::uint32_t longest)
    {
        const auto size = read<std::uint32_t>();
        if (size > longest)
            fail("a text claims " + std::to_string(size) + " characters");
        const auto part = take(size);
        return {part.begin(), part.end()};
    }

    std::uint64_t remaining() const { return bytes_.size() - position_; }

    void finish() const
    {
        if (remaining() != 0)
            fail("has " + std::to_string(remaining()) + " bytes too many");
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::string name_;
    std::string place_;
    std::uint64_t position_ = 0;
};

} // namespace strandlight
