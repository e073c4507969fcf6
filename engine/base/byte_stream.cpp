#include "engine/base/byte_stream.hpp"

#include "engine/base/error.hpp"

namespace strandlight {

void ByteWriter::text(const std::string& s)
{
    value(static_cast<std::uint32_t>(s.size()));
    append(s.data(), s.size());
}

// Not inline: GCC 12 warns falsely of an overflow where it inlines the growth of a vector.
void ByteWriter::append(const void* from, std::size_t count)
{
    const auto* begin = static_cast<const std::uint8_t*>(from);
    bytes_.insert(bytes_.end(), begin, begin + count);
}

std::string ByteReader::text(std::uint32_t longest)
{
    const auto count = value<std::uint32_t>();
    if (count > longest)
        fail("a text claims " + std::to_string(count) + " characters");
    const auto part = take(count);
    return {part.begin(), part.end()};
}

std::span<const std::uint8_t> ByteReader::take(std::uint64_t count)
{
    if (count > left())
        fail("ends at byte " + std::to_string(bytes_.size()) + ", " + std::to_string(count) +
             " bytes are needed from byte " + std::to_string(at_));
    const auto part = bytes_.subspan(at_, count);
    at_ += count;
    return part;
}

void ByteReader::seek(std::uint64_t position)
{
    if (position > bytes_.size())
        fail("continues at byte " + std::to_string(position) + " of " +
             std::to_string(bytes_.size()));
    at_ = position;
}

void ByteReader::finish() const
{
    if (left() != 0)
        fail("has " + std::to_string(left()) + " bytes too many");
}

void ByteReader::fail(const std::string& reason) const
{
    throw FileError(path_, place_.empty() ? "byte " + std::to_string(at_) : place_, reason);
}

} // namespace strandlight
