// The two networks as tables of layers; the device code (encoder.cpp, unet.cpp) and the CPU twins
// read the same tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compute_nn/conv_desc.hpp"
#include "compute_nn/parameter_layout.hpp"

namespace strandlight {

// Light-field encoder: image [N,3,S,S] -> raw lobes [N, 7 lobes, 1, 1].
// Four 3x3 convolutions of stride 2 and a dense layer, after Currius et al. 2020 (the paper's own
// table is not public; this is the project's documented baseline).
struct EncoderDesc
{
    std::uint32_t imageSize = 16; // directions per side
    std::uint32_t lobes = 8;
    float slope = 0.1f; // of the leaky relu after every convolution

    static constexpr std::array<std::uint32_t, 5> kChannels = {3, 16, 32, 64, 64};

    Conv2dDesc layer(std::uint32_t index) const // 0..3
    {
        return {.in = kChannels[index], .out = kChannels[index + 1], .stride = {2, 2}};
    }
    TensorDesc input(std::uint32_t images) const { return {images, 3, imageSize, imageSize}; }
    TensorDesc features(std::uint32_t images) const // the last convolution's output
    {
        TensorDesc desc = input(images);
        for (std::uint32_t i = 0; i < 4; ++i)
            desc = layer(i).output(desc, "encoder");
        return desc;
    }
    // The dense layer as a convolution whose kernel is the whole feature image.
    Conv2dDesc head() const
    {
        const TensorDesc f = features(1);
        return {.in = f.c, .out = lobes * 7, .kernel = {f.h, f.w}, .padding = {0, 0}};
    }
    ParameterLayout parameters() const;
};

// Filter: image [N,in,H,W] -> [N,out,H,W]; H and W are multiples of 2^levels.
// Ronneberger, Fischer, Brox. U-Net. 2015
// Level 0 has full size, every next one half of it. Going down, level l makes its skip; going up it
// makes `up`, and the next layer reads both, [up, skip]. The coarsest level has its skip alone.
// The defaults are the sizes of Currius, Assarsson, Sintorn 2022 (24 inputs, 3 outputs).
struct UNetDesc
{
    std::uint32_t in = 24;
    std::uint32_t out = 3;
    std::uint32_t head = 16; // channels of a 3x3 convolution at full size; 0: x is its own skip
    std::vector<std::uint32_t> down = {32, 48}; // of the 3x3 convolutions of stride 2
    std::vector<std::uint32_t> up = {32, 16};   // of the transposed ones, from the coarsest on
    std::uint32_t upKernel = 2; // 2: 2x2 without padding, 4: 4x4 with padding 1; stride 2
    float slope = 0.1f;         // of the leaky relu after every layer but the last

    std::uint32_t levels() const { return std::uint32_t(down.size()); } // below full size
    std::uint32_t skipChannels(std::uint32_t level) const
    {
        return level > 0 ? down[level - 1] : head > 0 ? head : in;
    }
    std::uint32_t upChannels(std::uint32_t level) const // 0 at the coarsest level
    {
        return level < levels() ? up[levels() - 1 - level] : 0;
    }
    std::uint32_t channels(std::uint32_t level) const // of [up, skip]
    {
        return upChannels(level) + skipChannels(level);
    }
    TensorDesc level(std::uint32_t index, const TensorDesc& x) const // shape of [up, skip]
    {
        return {x.n, channels(index), x.h >> index, x.w >> index};
    }

    Conv2dDesc encoder(std::uint32_t level) const // makes the skip of that level; 0: the head
    {
        if (level == 0)
            return {.in = in, .out = head};
        return {.in = skipChannels(level - 1), .out = skipChannels(level), .stride = {2, 2}};
    }
    ConvTranspose2dDesc decoder(std::uint32_t level) const // makes `up` of that level
    {
        const std::uint32_t padding = upKernel / 2 - 1;
        return {.in = channels(level + 1),
                .out = upChannels(level),
                .kernel = {upKernel, upKernel},
                .padding = {padding, padding}};
    }
    Conv2dDesc last() const { return {.in = channels(0), .out = out}; }
    // enc0 (the head), enc1, ..., then the decoder from the coarsest to dec0, then out.
    ParameterLayout parameters() const;
    // Throws Error when x is no input of this network, or this is no network.
    void check(const TensorDesc& x) const;
};

enum class HairUNetSize : std::uint32_t
{
    Small,
    Medium,
    Large
};

// The hair filter: 26 planes -> brightness, illumination, transmittance and the nine logits of a
// kernel (passes/hair_filter.hpp). Without a head, as small and medium, the planes themselves are
// the last skip.
UNetDesc hairUNet(HairUNetSize size = HairUNetSize::Medium);

// A network to time kernels with: four levels, 4x4 transposed kernels, 24 planes -> 3.
UNetDesc benchmarkUNet();

} // namespace strandlight
