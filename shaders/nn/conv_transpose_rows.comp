// Transposed convolution, and the data gradient of a convolution, by a sliding window along rows.
// Dumoulin and Visin. A guide to convolution arithmetic for deep learning. 2016
//
// An invocation computes all column phases of its blocks (transpose_phases.glsl), and all row phases or, where PHASES is
// SH, one of them: fewer sums for as many taps each. Otherwise as conv_rows.comp.
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
#include "nn/transpose_phases.glsl"

const uint ROWS = SH / PHASES; // of the result
const uint ROW_TAPS = KH / PHASES;
const uint WH = PHASES == SH ? ROW_TAPS : UP + 1 + DOWN;
const uint WW = LEFT + NX + RIGHT;
const uint ROW_STEP = 1;

#include "nn/conv_window.glsl"

void main()
{
    Strip strip = stripOfInvocation(SH, SW);
    Target target = targetOf(strip);
    uint group = groupOfInvocation();
    uint phase = group % PHASES;
    int firstRow = PHASES == SH ? int((phase + PH) / SH) - int(ROW_TAPS - 1) : -int(UP);
    placeWindow(int(strip.row) + firstRow, int(strip.column), strip.image);
    float sum[K][ROWS][NX * SW];
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint y = 0; y < ROWS; ++y)
            [[unroll]] for (uint x = 0; x < NX * SW; ++x)
                sum[k][y][x] = 0.0;

    uint turns = push.inChannels / U;
    int planeLoads = int(push.source.height * push.source.width / SPAN);
    int plane = 0;
    int weights = int(group * turns * TURN_TEXELS);
    for (uint turn = 0; turn < turns; ++turn) {
        dealWeights(weights);
        [[unroll]] for (uint u = 0; u < U; ++u) {
            loadWindow(plane);
            [[unroll]] for (uint k = 0; k < K; ++k)
                [[unroll]] for (uint t = 0; t < TAPS; ++t) {
                    float weight = dealtWeight(weights, (u * K + k) * TAPS + t);
                    uint ky = t / KW, kx = t % KW;
                    uint y = PHASES == SH ? 0 : phaseOfTapY(ky);
                    uint row = PHASES == SH ? ROW_TAPS - 1 - ky : rowOfTap(ky);
                    [[unroll]] for (uint n = 0; n < NX; ++n)
                        sum[k][y][n * SW + phaseOfTapX(kx)] += weight * window[row][columnOfTap(kx) + n];
                }
            plane += planeLoads;
        }
        weights += int(TURN_TEXELS);
    }

    uint firstChannel = group / PHASES * K;
    uint firstY = strip.row * SH + phase, firstX = strip.column * SW;
    [[unroll]] for (uint k = 0; k < K; ++k) {
        float bias = biasOf(firstChannel + k);
        [[unroll]] for (uint y = 0; y < ROWS; ++y) {
#ifdef RESULT_WIDE
            [[unroll]] for (uint x = 0; x < NX * SW; x += 8)
                storeOctet(target, firstChannel + k, firstY + y, firstX + x,
                           vec4(sum[k][y][x], sum[k][y][x + 1], sum[k][y][x + 2], sum[k][y][x + 3]) + bias,
                           vec4(sum[k][y][x + 4], sum[k][y][x + 5], sum[k][y][x + 6], sum[k][y][x + 7]) + bias);
#else
            if ((FLAGS & kConvQuads) != 0) {
                [[unroll]] for (uint x = 0; x < NX * SW; x += 4)
                    storeQuad(target, firstChannel + k, firstY + y, firstX + x,
                              vec4(sum[k][y][x], sum[k][y][x + 1], sum[k][y][x + 2], sum[k][y][x + 3]) + bias);
            } else {
                [[unroll]] for (uint x = 0; x < NX * SW; ++x)
                    storeFloat(target, firstChannel + k, firstY + y, firstX + x, sum[k][y][x] + bias);
            }
#endif
        }
    }
    reportLargest();
}
