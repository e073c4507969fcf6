// The register tile of an invocation that computes K output channels of a strip: one block of sums (conv_sums.glsl) each.
// Behind conv_rows.glsl and the `window` of input pixels that a strip reads of one channel.
#ifndef STRANDLIGHT_NN_CONV_STRIP_GLSL
#define STRANDLIGHT_NN_CONV_STRIP_GLSL

const uint SUM_BLOCKS = K;

#include "nn/conv_sums.glsl"

void addTaps(int weights, uint u)
{
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint t = 0; t < TAPS; ++t) {
            float weight = dealtWeight(weights, (u * K + k) * TAPS + t);
            [[unroll]] for (uint n = 0; n < NX; ++n)
                sum[k][n] += weight * window[t / KW][n * SW + t % KW];
        }
}

void addPoints(int weights, uint u)
{
    MinimalPoints points[KH][COLUMN_TILES];
    [[unroll]] for (uint ky = 0; ky < KH; ++ky)
        [[unroll]] for (uint tile = 0; tile < COLUMN_TILES; ++tile)
            points[ky][tile] = pointsOfWindow(ky, tile);
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint ky = 0; ky < KH; ++ky)
            [[unroll]] for (uint j = 0; j < kMinimalPoints; ++j) {
                float weight = dealtWeight(weights, (u * K + k) * TAPS + ky * kMinimalPoints + j);
                [[unroll]] for (uint tile = 0; tile < COLUMN_TILES; ++tile)
                    sum[k][tile * kMinimalPoints + j] += weight * points[ky][tile].at[j];
            }
}

// The window of input channel `u` of a turn, whose weights are dealt and begin at `weights`.
void addWindow(int weights, uint u)
{
    if (MINIMAL)
        addPoints(weights, u);
    else
        addTaps(weights, u);
}

void storeSums(Strip strip, Target target)
{
    uint firstChannel = groupOfInvocation() * K;
    [[unroll]] for (uint k = 0; k < K; ++k)
        storeBlock(k, target, firstChannel + k, strip.row, strip.column, biasOf(firstChannel + k));
    reportLargest();
}

#endif
