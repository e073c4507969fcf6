// Move-only device buffer: storage, texel, indirect and transfer usage; device-local, with staged
// upload and readback.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace strandlight {

class Context;
struct BufferState;

class Buffer
{
public:
    Buffer() noexcept; // defined in the source: BufferState is incomplete here
    Buffer(Context& context, std::uint64_t bytes, std::string name); // zero-filled
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();

    template <class T>
    static Buffer from(Context& context, std::span<const T> data, std::string name)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        // A binding cannot be empty: an empty array becomes one zeroed element.
        Buffer buffer(context, data.empty() ? sizeof(T) : data.size_bytes(), std::move(name));
        buffer.upload(std::as_bytes(data));
        return buffer;
    }
    template <class T>
    static Buffer from(Context& context, const std::vector<T>& data, std::string name)
    {
        return from(context, std::span<const T>(data), std::move(name));
    }

    bool valid() const { return state_ != nullptr; }
    std::uint64_t bytes() const;
    const std::string& name() const;

    void upload(std::span<const std::byte> data, std::uint64_t offset = 0); // waits
    std::vector<std::byte> download() const;                                // waits
    template <class T> std::vector<T> downloadAs() const
    {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::vector<std::byte> raw = download();
        std::vector<T> values(raw.size() / sizeof(T));
        std::memcpy(values.data(), raw.data(), values.size() * sizeof(T));
        return values;
    }

    BufferState& state() const { return *state_; }

private:
    std::unique_ptr<BufferState> state_;
};

} // namespace strandlight
