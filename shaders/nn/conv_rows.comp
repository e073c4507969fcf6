// Convolution, and the data gradient of a transposed one, by a sliding window along rows; strided kernels of a few sizes.
// Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
//
// Per input channel an invocation loads the window of its strip once, KH rows of NR columns, and its K x TAPS weights
// dealt to eight lanes. The sums of one channel stay in registers through all taps; the window is small enough to be
// an operand from the stack. (With the taps outermost the sums travel to the stack and back at every tap.)
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "nn/conv_rows.glsl"

const uint NR = (NX - 1) * SW + KW;

void main()
{
    Strip strip = stripOfInvocation(1, 1);
    uint firstChannel = firstChannelOfInvocation();

    // Addresses are clamped into the image and what lies outside is replaced by zero: a select, not a product, for NaN
    // must not leak in.
    int rowAddress[KH], columnAddress[NR];
    bool rowInside[KH], columnInside[NR];
    [[unroll]] for (uint i = 0; i < KH; ++i) {
        int y = int(strip.row * SH + i) - int(PH);
        rowInside[i] = uint(y) < push.source.height;
        rowAddress[i] = clamp(y, 0, int(push.source.height) - 1) * int(push.source.width);
    }
    [[unroll]] for (uint i = 0; i < NR; ++i) {
        int x = int(strip.column * SW + i) - int(PW);
        columnInside[i] = uint(x) < push.source.width;
        columnAddress[i] = clamp(x, 0, int(push.source.width) - 1);
    }
    int laneAddress[LOADS];
    [[unroll]] for (uint j = 0; j < LOADS; ++j)
        laneAddress[j] = laneWeightAddress(j);

    float sum[K][NX];
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint n = 0; n < NX; ++n)
            sum[k][n] = 0.0;

    int plane = int(push.source.height * push.source.width);
    int source = int(push.source.offset + strip.image * push.source.imageStride);
    int weights = 0;
    for (uint c = 0; c < push.inChannels; c += U) {
        [[unroll]] for (uint u = 0; u < U; ++u) {
            float dealt[LOADS];
            if ((FLAGS & kConvShuffle) != 0)
                [[unroll]] for (uint j = 0; j < LOADS; ++j)
                    dealt[j] = imageLoad(parameters, weights + laneAddress[j]).x;
            float window[KH][NR];
            [[unroll]] for (uint y = 0; y < KH; ++y)
                [[unroll]] for (uint x = 0; x < NR; ++x) {
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
                    [[unroll]] for (uint n = 0; n < NX; ++n)
                        sum[k][n] += weight * window[t / KW][n * SW + t % KW];
                }
            source += plane;
            weights += int(push.weightStrideIn);
        }
    }

    [[unroll]] for (uint k = 0; k < K; ++k) {
        float bias = biasOf(firstChannel + k);
        [[unroll]] for (uint n = 0; n < NX; ++n)
            store(strip, firstChannel + k, strip.row, strip.column + n, sum[k][n] + bias);
    }
}
