// Weights of a predicted kernel (reference/kernel_filter.hpp).
#ifndef STRANDLIGHT_NN_FILTER_WEIGHTS_GLSL
#define STRANDLIGHT_NN_FILTER_WEIGHTS_GLSL

#include "shared/nn_types.h"
#include "nn/nn_math.glsl"

// Logits to the softmax over the taps inside, 0 for the others. The largest logit is subtracted so that no exponential
// overflows. A NaN among them spreads through the sum.
void filterWeights(inout float weight[kFilterTaps], bool inside[kFilterTaps])
{
    float largest = uintBitsToFloat(0xff800000u);
    for (uint k = 0; k < kFilterTaps; ++k)
        largest = inside[k] && weight[k] > largest ? weight[k] : largest;
    float sum = 0.0;
    for (uint k = 0; k < kFilterTaps; ++k) {
        weight[k] = inside[k] ? nnExp(weight[k] - largest) : 0.0;
        sum += weight[k];
    }
    for (uint k = 0; k < kFilterTaps; ++k)
        weight[k] /= sum;
}

#endif
