// The two networks as tables of layers; the device code (encoder.cpp, unet.cpp) and the CPU twins
// read the same tables.
#pragma once

#include <array>
#include <cstdint>

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

// Filter: image [N,24,H,W] -> [N,3,H,W]; H and W are multiples of 4.
// Ronneberger, Fischer, Brox. U-Net. 2015; sizes after Currius, Assarsson, Sintorn 2022 (24 inputs,
// 3 outputs).
struct UNetDesc
{
    std::uint32_t in = 24;
    std::uint32_t out = 3;
    std::array<std::uint32_t, 3> channels = {16, 32, 48}; // full, half, quarter size
    float slope = 0.1f;

    Conv2dDesc enc0() const { return {.in = in, .out = channels[0]}; }
    Conv2dDesc enc1() const { return {.in = channels[0], .out = channels[1], .stride = {2, 2}}; }
    Conv2dDesc enc2() const { return {.in = channels[1], .out = channels[2], .stride = {2, 2}}; }
    ConvTranspose2dDesc dec1() const { return {.in = channels[2], .out = channels[1]}; }
    ConvTranspose2dDesc dec0() const { return {.in = 2 * channels[1], .out = channels[0]}; }
    Conv2dDesc last() const { return {.in = 2 * channels[0], .out = out}; }
    ParameterLayout parameters() const;
    void check(const TensorDesc& x) const; // throws Error when x is no input of this network
};

} // namespace strandlight
