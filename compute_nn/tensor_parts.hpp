// Parts of tensors that are larger than one binding: ranges of images, then of one image's
// channels, bound by themselves. Internal to the passes.
#pragma once

#include <initializer_list>

#include "compute_nn/tensor.hpp"

namespace strandlight {

// Whether all of the buffers can be bound whole; what is bound in part already can.
bool fitBindings(const RenderGraph& graph, std::initializer_list<TensorId> tensors);

// Images or channels [first, first + count) of a tensor, and nothing else of its buffer bound.
TensorId boundPart(const TensorId& tensor, std::uint32_t firstImage, std::uint32_t images,
                   std::uint32_t firstChannel, std::uint32_t channels);

// Images of these tensors whose parts can be bound, at least 1.
std::uint32_t imagesPerPart(const RenderGraph& graph, std::initializer_list<TensorId> tensors);
// Of so many images of `floats` each, packed: all, or as many as can be bound, then a multiple of
// 64, so that every part begins where a binding may. Throws Error when 64 are too large.
std::uint32_t flatImagesPerPart(const RenderGraph& graph, std::string_view pass,
                                std::uint32_t images, std::uint64_t floats);
// Of such images those from `first` on; the last ones to the end of the buffer, since a view of
// whole texels need not end where the tensor does.
Binding flatPart(BufferId buffer, std::uint32_t images, std::uint64_t floats, std::uint32_t first,
                 std::uint32_t count);
// Channels of one image that can be bound, up to all. Throws Error when one plane is too large.
std::uint32_t channelsPerPart(const RenderGraph& graph, std::string_view pass,
                              const TensorId& tensor);

} // namespace strandlight
