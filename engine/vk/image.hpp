// Move-only device image with its default view. Storage, sampled, attachment and transfer usage by
// format.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "engine/base/image.hpp"
#include "engine/vk/image_desc.hpp"

namespace strandlight {

class Context;
struct ImageState;

class Image
{
public:
    Image() noexcept; // defined in the source: ImageState is incomplete here
    Image(Context& context, const ImageDesc& desc, std::string name); // cleared to zero
    Image(Image&&) noexcept;
    Image& operator=(Image&&) noexcept;
    ~Image();

    bool valid() const { return state_ != nullptr; }
    const ImageDesc& desc() const;
    const std::string& name() const;

    // RGBA fp32 pixels of one layer; converted to the image's format. Waits.
    void upload(const CpuImage& pixels, std::uint32_t layer = 0);
    CpuImage download(std::uint32_t layer = 0) const;

    ImageState& state() const { return *state_; }

private:
    std::unique_ptr<ImageState> state_;
};

} // namespace strandlight
