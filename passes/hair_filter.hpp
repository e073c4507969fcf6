// The hair filter: samples, through a network that predicts brightness, transmittance and a colour
// kernel, to hair over a background.
// Currius, Assarsson, Sintorn. Real-Time Hair Filtering with Convolutional Neural Networks. 2022
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compute_nn/half_guard.hpp"
#include "compute_nn/network_shapes.hpp"
#include "compute_nn/parameters.hpp"
#include "compute_nn/unet_tiles.hpp"
#include "passes/hair_passes.hpp"

namespace strandlight {

struct HairFilterInput
{
    HairSampleIds samples; // with features
    ImageId blended;       // RGBA32F (addHairBlendPass)
    HairDepthScale depth;
};

struct HairFilterSettings
{
    // Of the picture, filtered at once; a multiple of 8, 0: as many as the device can bind. What
    // a band's pixels see of its neighbours is computed twice, so bands change no bit.
    std::uint32_t bandRows = 0;
    // Compute only what pixels with hair need, in every layer. Changes no bit either.
    bool skipTiles = true;
    // The layers that read the network's input fetch it from the samples (hair_conv.hpp): less
    // memory, the same bits; as halves the input is then not rounded. None: where it pays.
    std::optional<bool> fuseFetch;
    // Not null: the network's input and levels are stored as halves (--precision fp16).
    HalfGuard* halves = nullptr;
};

struct HairComposite
{
    ImageId filtered;              // RGBA32F: premultiplied hair radiance, 1 - transmittance
    ImageId radiance;              // RGBA32F: hair over the background
    std::vector<LayerTiles> tiles; // of every band's layers; empty without skipTiles
};

// `over` holds zeros in `filtered` and the background in `radiance`. Pixels whose blended
// transmittance is 1 keep both. Throws Error when the network is not one of 26 planes to 12 whose
// levels divide 8.
HairComposite addHairFilterPasses(RenderGraph& graph, const UNetDesc& net,
                                  const ParameterIds& parameters, const HairFilterInput& input,
                                  const HairComposite& over,
                                  const HairFilterSettings& settings = {});

} // namespace strandlight
