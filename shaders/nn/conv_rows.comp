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
const uint ROW_STEP = 1;

#include "nn/conv_window.glsl"
#include "nn/conv_strip.glsl"

void main()
{
    Strip strip = stripOfInvocation(1, 1);
    Target target = targetOf(strip);
    placeWindow(int(strip.row * SH) - int(PH), int(strip.column * SW), strip.image);
    clearSums();

    uint turns = push.inChannels / U;
    int planeLoads = int(push.source.height * push.source.width / SPAN);
    int plane = 0;
    int weights = int(groupOfInvocation() * turns * TURN_TEXELS);
    for (uint turn = 0; turn < turns; ++turn) {
        dealWeights(weights);
        [[unroll]] for (uint u = 0; u < U; ++u) {
            loadWindow(plane);
            addWindow(weights, u);
            plane += planeLoads;
        }
        weights += int(TURN_TEXELS);
    }
    storeSums(strip, target);
}
