// Transposed convolution, and the data gradient of a convolution, on a CPU device, lanes being output channels
// (conv_lanes.glsl). An invocation computes all phases of its blocks (transpose_phases.glsl).
//
// Sums are taken in the order of conv_transpose_rows.comp and have its bits.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#define RESULT_WIDE
#include "nn/conv_rows.glsl"

#include "nn/transpose_phases.glsl"

layout(constant_id = 12) const uint TILE_ROWS = 6;

const uint INPUT_ROWS = UP + TILE_ROWS + DOWN;
const uint WW = LEFT + NX + RIGHT;
const uint RESULT_ROWS = TILE_ROWS * SH;

#include "nn/conv_lanes.glsl"

float sum[VECTORS][RESULT_ROWS][NX * SW];

void addTaps(uint u)
{
    float pixel[INPUT_ROWS][WW];
    [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
        [[unroll]] for (uint x = 0; x < WW; ++x)
            pixel[row][x] = ofRow(window[row / ROW_STEP][x], row);
    [[unroll]] for (uint v = 0; v < VECTORS; ++v)
        [[unroll]] for (uint y = 0; y < RESULT_ROWS; ++y)
            [[unroll]] for (uint t = 0; t < TAPS; ++t) {
                uint ky = t / KW, kx = t % KW;
                if (phaseOfTapY(ky) != y % SH)
                    continue;
                [[unroll]] for (uint n = 0; n < NX; ++n)
                    sum[v][y][n * SW + phaseOfTapX(kx)] +=
                        weightOf(u, v, t) * pixel[y / SH + rowOfTap(ky)][columnOfTap(kx) + n];
            }
}

void main()
{
    Strip tile = tileOfGroup(SH, SW);
    Target target = targetOf(tile);
    placeRows(int(tile.row) - int(UP), tile, tile.column);
    [[unroll]] for (uint v = 0; v < VECTORS; ++v)
        [[unroll]] for (uint y = 0; y < RESULT_ROWS; ++y)
            [[unroll]] for (uint x = 0; x < NX * SW; ++x)
                sum[v][y][x] = 0.0;

    uint turns = push.inChannels / U;
    int planeLoads = int(push.source.height * push.source.width / SPAN);
    int plane = 0;
    int texel = firstWeights();
    for (uint turn = 0; turn < turns; ++turn) {
        loadWeights(texel);
        [[unroll]] for (uint u = 0; u < U; ++u) {
            loadWindow(plane);
            addTaps(u);
            plane += planeLoads;
        }
        texel += int(WEIGHT_LOADS * kLanes);
    }

    [[unroll]] for (uint v = 0; v < VECTORS; ++v) {
        float bias = biasOf(channelOf(v));
        [[unroll]] for (uint y = 0; y < RESULT_ROWS; ++y)
            [[unroll]] for (uint x = 0; x < NX * SW; x += 8)
                storeOctet(target, channelOf(v), tile.row * SH + y, tile.column * SW + x,
                           vec4(sum[v][y][x], sum[v][y][x + 1], sum[v][y][x + 2], sum[v][y][x + 3]) + bias,
                           vec4(sum[v][y][x + 4], sum[v][y][x + 5], sum[v][y][x + 6], sum[v][y][x + 7]) + bias);
    }
}
