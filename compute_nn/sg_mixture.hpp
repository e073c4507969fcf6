// Spherical-gaussian decoder and mixture as passes. Twin: reference/sg_mixture.hpp
#pragma once

#include <string_view>

#include "compute_nn/tensor.hpp"

namespace strandlight {

// How a radiance tensor [N, D, 3] or [N, 3, D] and its directions lie in memory.
struct SgMixtureDesc
{
    std::uint32_t images = 1;
    std::uint32_t lobes = 8;
    std::uint32_t directions = 1;
    bool sharedDirections = true; // [D,3]; false: [N,D,3]
    bool planar = true;           // radiance [N,3,D]; false: [N,D,3]

    TensorDesc raw() const { return {images, lobes * 7, 1, 1}; } // [N,L,7]
    std::uint64_t radianceElements() const { return std::uint64_t(images) * directions * 3; }
};

// raw [N,L,7] -> lobes [N,L,7]: axis (unit), sharpness, amplitude.
TensorId addSgDecodePass(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw);

// lobes [N,L,7], directions (unit) -> radiance (whole tensor of radianceElements()), overwritten.
TensorId sgMixtureForward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& lobes,
                          BufferId directions, const TensorId& radiance);

// dRadiance -> dRaw [N,L,7] through mixture and decoder, overwritten. Saved: raw, directions.
TensorId sgMixtureBackward(RenderGraph& graph, const SgMixtureDesc& desc, const TensorId& raw,
                           BufferId directions, const TensorId& dRadiance, const TensorId& dRaw);

} // namespace strandlight
