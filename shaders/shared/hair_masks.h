// Which of a pixel's four samples a fragment covers: k of 4, chosen by a hash of the fragment.
// Enderton, Sintorn, Shirley, Luebke. Stochastic Transparency. 2010 (alpha to stratified masks)
// A hash of the pixel alone would make the masks of stacked layers coincide: their product would be biased.
#ifndef STRANDLIGHT_SHARED_HAIR_MASKS_H
#define STRANDLIGHT_SHARED_HAIR_MASKS_H

#ifdef __cplusplus
#include "shaders/shared/nan_bits.h"
#include "shaders/shared/rng.h"
#else
#include "shared/nan_bits.h"
#include "shared/rng.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Random bits of one fragment: .x chooses k, .y which samples.
STRANDLIGHT_FN uvec3 hairFragmentBits(uint strand, uint segment, uint pixelX, uint pixelY, uint frame)
{
    uint item = hashPcg(strand * 0x9E3779B9u + segment);
    return hashPcg3(uvec3(item, pixelX | (pixelY << 16u), hashPcg(frame)));
}

// One of the C(4, k) masks with k bits, all equally likely.
STRANDLIGHT_FN uint hairMaskOfCount(uint k, uint bits)
{
    if (k == 0u) {
        return 0u;
    }
    if (k >= 4u) {
        return 15u;
    }
    uint one = 1u << (bits >> 30u);
    if (k == 1u) {
        return one;
    }
    if (k == 3u) {
        return 15u ^ one;
    }
    // The six masks of two samples, four bits each: 3, 5, 6, 9, 10, 12.
    uint pair = uint(uniformFloat(bits) * 6.0f);
    return (0xCA9653u >> (4u * pair)) & 15u;
}

// A mask whose expected share of samples is alpha. NaN gives no sample.
STRANDLIGHT_FN uint hairSampleMask(float alpha, uvec3 bits)
{
    if (alpha <= 0.0f || isNanByBits(alpha)) {
        return 0u;
    }
    float share = min(alpha, 1.0f) * 4.0f;
    uint k = uint(share);
    // Not floor(share + xi): that sum can round up to the next whole number.
    k += uniformFloat(bits.x) < share - float(k) ? 1u : 0u;
    return hairMaskOfCount(k, bits.y);
}

STRANDLIGHT_SHARED_END

#endif
