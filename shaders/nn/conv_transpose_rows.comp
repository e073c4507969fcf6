// Transposed convolution, and the data gradient of a convolution, by a sliding window along rows.
// Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
//
// A row and column of the grid is a block of SH x SW pixels of the result, one of each phase (y mod SH, x mod SW). An
// invocation computes whole blocks, so each of the taps is used once per block and no lane multiplies by a structural
// zero. Tap (ky,kx) of input pixel (r,c) lands on pixel (r SH - PH + ky, c SW - PW + kx). Otherwise as conv_rows.comp.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "nn/conv_rows.glsl"

// Input rows that reach a block: UP before and DOWN behind the block's own. The host keeps the padding below the kernel.
const uint UP = (KH - 1 - PH) / SH;
const uint DOWN = (PH + SH - 1) / SH;
const uint LEFT = (KW - 1 - PW) / SW;
const uint RIGHT = (PW + SW - 1) / SW;
const uint WH = UP + 1 + DOWN;
const uint WW = LEFT + NX + RIGHT;

void main()
{
    Strip strip = stripOfInvocation(SH, SW);
    uint firstChannel = firstChannelOfInvocation();

    int rowAddress[WH], columnAddress[WW];
    bool rowInside[WH], columnInside[WW];
    [[unroll]] for (uint i = 0; i < WH; ++i) {
        int y = int(strip.row + i) - int(UP);
        rowInside[i] = uint(y) < push.source.height;
        rowAddress[i] = clamp(y, 0, int(push.source.height) - 1) * int(push.source.width);
    }
    [[unroll]] for (uint i = 0; i < WW; ++i) {
        int x = int(strip.column + i) - int(LEFT);
        columnInside[i] = uint(x) < push.source.width;
        columnAddress[i] = clamp(x, 0, int(push.source.width) - 1);
    }
    int laneAddress[LOADS];
    [[unroll]] for (uint j = 0; j < LOADS; ++j)
        laneAddress[j] = laneWeightAddress(j);

    float sum[K][SH][NX * SW];
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint y = 0; y < SH; ++y)
            [[unroll]] for (uint x = 0; x < NX * SW; ++x)
                sum[k][y][x] = 0.0;

    int plane = int(push.source.height * push.source.width);
    int source = int(push.source.offset + strip.image * push.source.imageStride);
    int weights = 0;
    for (uint c = 0; c < push.inChannels; c += U) {
        [[unroll]] for (uint u = 0; u < U; ++u) {
            float dealt[LOADS];
            if ((FLAGS & kConvShuffle) != 0)
                [[unroll]] for (uint j = 0; j < LOADS; ++j)
                    dealt[j] = imageLoad(parameters, weights + laneAddress[j]).x;
            float window[WH][WW];
            [[unroll]] for (uint y = 0; y < WH; ++y)
                [[unroll]] for (uint x = 0; x < WW; ++x) {
                    float loaded = imageLoad(inputTensor, source + rowAddress[y] + columnAddress[x]).x;
                    window[y][x] = rowInside[y] && columnInside[x] ? loaded : 0.0;
                }
            [[unroll]] for (uint k = 0; k < K; ++k)
                [[unroll]] for (uint t = 0; t < TAPS; ++t) {
                    uint e = k * TAPS + t;
                    float weight;
                    if ((FLAGS & kConvShuffle) != 0)
                        weight = subgroupShuffle(dealt[e / kLanes], e % kLanes);
                    else
                        weight = imageLoad(parameters, weights + weightAddress(firstChannel + k, t)).x;
                    // The phase this tap lands on, and which row and column of the window it comes from.
                    uint ky = t / KW, kx = t % KW;
                    uint phaseY = (ky + (SH - 1) * PH) % SH, phaseX = (kx + (SW - 1) * PW) % SW;
                    uint fromY = (phaseY + PH + UP * SH - ky) / SH, fromX = (phaseX + PW + LEFT * SW - kx) / SW;
                    [[unroll]] for (uint n = 0; n < NX; ++n)
                        sum[k][phaseY][n * SW + phaseX] += weight * window[fromY][fromX + n];
                }
            source += plane;
            weights += int(push.weightStrideIn);
        }
    }

    [[unroll]] for (uint k = 0; k < K; ++k) {
        float bias = biasOf(firstChannel + k);
        [[unroll]] for (uint y = 0; y < SH; ++y)
            [[unroll]] for (uint x = 0; x < NX * SW; ++x)
                store(strip, firstChannel + k, strip.row * SH + y, strip.column * SW + x, sum[k][y][x] + bias);
    }
}
