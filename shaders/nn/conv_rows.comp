// Convolution, and the data gradient of a transposed one, by a sliding window along rows; strided kernels of a few sizes.
// Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
//
// Per input channel an invocation loads the window of its strip once, and its K x TAPS weights dealt to eight lanes. The
// sums of one channel stay in registers through all taps; the window is small enough to be an operand from the stack.
// (With the taps outermost the sums travel to the stack and back at every tap.)
// VARIANT half SOURCE_HALF RESULT_HALF
// VARIANT from_half SOURCE_HALF
// VARIANT wide RESULT_WIDE
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "nn/conv_rows.glsl"

const uint WH = KH;
const uint WW = (NX - 1) * SW + KW;
const uint LEFT = PW;

#include "nn/conv_window.glsl"

void main()
{
    Strip strip = stripOfInvocation(1, 1);
    Target target = targetOf(strip);
    placeWindow(int(strip.row * SH) - int(PH), int(strip.column * SW), strip.image);
    float sum[K][NX];
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint n = 0; n < NX; ++n)
            sum[k][n] = 0.0;

    uint turns = push.inChannels / U;
    int planeLoads = int(push.source.height * push.source.width / SPAN);
    int plane = 0;
    int weights = int(groupOfInvocation() * turns * TURN_TEXELS);
    for (uint turn = 0; turn < turns; ++turn) {
        dealWeights(weights);
        [[unroll]] for (uint u = 0; u < U; ++u) {
            loadWindow(plane);
            [[unroll]] for (uint k = 0; k < K; ++k)
                [[unroll]] for (uint t = 0; t < TAPS; ++t) {
                    float weight = dealtWeight(weights, (u * K + k) * TAPS + t);
                    [[unroll]] for (uint n = 0; n < NX; ++n)
                        sum[k][n] += weight * window[t / KW][n * SW + t % KW];
                }
            plane += planeLoads;
        }
        weights += int(TURN_TEXELS);
    }

    uint firstChannel = groupOfInvocation() * K;
    [[unroll]] for (uint k = 0; k < K; ++k) {
        float bias = biasOf(firstChannel + k);
#ifdef RESULT_WIDE
        [[unroll]] for (uint n = 0; n < NX; n += 8)
            storeOctet(target, firstChannel + k, strip.row, strip.column + n,
                       vec4(sum[k][n], sum[k][n + 1], sum[k][n + 2], sum[k][n + 3]) + bias,
                       vec4(sum[k][n + 4], sum[k][n + 5], sum[k][n + 6], sum[k][n + 7]) + bias);
#else
        if ((FLAGS & kConvQuads) != 0) {
            [[unroll]] for (uint n = 0; n < NX; n += 4)
                storeQuad(target, firstChannel + k, strip.row, strip.column + n,
                          vec4(sum[k][n], sum[k][n + 1], sum[k][n + 2], sum[k][n + 3]) + bias);
        } else {
            [[unroll]] for (uint n = 0; n < NX; ++n)
                storeFloat(target, firstChannel + k, strip.row, strip.column + n, sum[k][n] + bias);
        }
#endif
    }
    reportLargest();
}
