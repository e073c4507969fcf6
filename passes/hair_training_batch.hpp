// Crops of training frames as the network's tensors, in all the ways that a frame may be turned
// round without becoming another kind of picture.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "passes/hair_training_data.hpp"

namespace strandlight {

// One of the eight symmetries of a square, a numbering of the four samples, another exposure.
struct HairAugmentation
{
    bool transpose = false; // of x and y; before the flips
    bool flipX = false;
    bool flipY = false;
    std::array<std::uint8_t, 4> samples = {0, 1, 2, 3}; // sample s comes from samples[s]
    float exposure = 1.0f;                              // factor on all radiance
};

// n crops of `size` pixels a side, planar [n, planes, size, size].
struct HairBatch
{
    std::uint32_t n = 0;
    std::uint32_t size = 0;
    std::vector<float> input;  // [n,26,..] what the network reads
    std::vector<float> target; // [n,12,..] what it should say; 0 for the logits
    std::vector<float> image;  // [n,4,..] premultiplied radiance of the four samples' mean, 0
    std::vector<float> truth;  // [n,4,..] that of the supersampled frame, 0
};

inline constexpr std::uint32_t kHairOutputs = 12; // 3 and 9 logits

HairBatch makeHairBatch(std::uint32_t n, std::uint32_t size);

// Fills crop `slot` from the square whose upper left pixel is (x, y) before it is turned round.
void fillHairCrop(HairBatch& batch, std::uint32_t slot, const HairTrainingFrame& frame,
                  std::uint32_t repeat, glm::uvec2 corner, const HairAugmentation& how);

// A step's crops: frames, noises, places with hair and augmentations drawn from (seed, step).
HairBatch drawHairBatch(std::span<const HairTrainingFrame> frames, std::uint32_t n,
                        std::uint32_t size, std::uint32_t seed, std::uint32_t step);

} // namespace strandlight
