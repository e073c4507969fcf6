// Convolution on a CPU device, lanes being output channels (conv_lanes.glsl).
//
// Plain sums are taken in the order of conv_rows.comp and have its bits; those at points have the bits of hair_conv.comp.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#define RESULT_WIDE
#include "nn/conv_rows.glsl"

layout(constant_id = 12) const uint TILE_ROWS = 6;

const uint INPUT_ROWS = (TILE_ROWS - 1) * SH + KH;
const uint WW = (NX - 1) * SW + KW;
const uint LEFT = PW;

#include "nn/conv_lanes.glsl"

const uint SUM_BLOCKS = VECTORS * TILE_ROWS; // [vector][row]

#include "nn/conv_sums.glsl"

void addTaps(uint u)
{
    float pixel[INPUT_ROWS][WW];
    [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
        [[unroll]] for (uint x = 0; x < WW; ++x)
            pixel[row][x] = ofRow(window[row / ROW_STEP][x], row);
    [[unroll]] for (uint i = 0; i < SUM_BLOCKS; ++i)
        [[unroll]] for (uint t = 0; t < TAPS; ++t)
            [[unroll]] for (uint n = 0; n < NX; ++n)
                sum[i][n] += weightOf(u, i / TILE_ROWS, t) * pixel[i % TILE_ROWS * SH + t / KW][n * SW + t % KW];
}

// Rows outermost: three rows of sums at a time fit the registers, and each point is loaded from the stack once.
void addPoints(uint u)
{
    float point[INPUT_ROWS][COLUMN_TILES][kMinimalPoints];
    [[unroll]] for (uint tile = 0; tile < COLUMN_TILES; ++tile) {
        MinimalPoints mine[WH];
        [[unroll]] for (uint g = 0; g < WH; ++g)
            mine[g] = pointsOfWindow(g, tile);
        [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
            [[unroll]] for (uint j = 0; j < kMinimalPoints; ++j)
                point[row][tile][j] = ofRow(mine[row / ROW_STEP].at[j], row);
    }
    [[unroll]] for (uint j = 0; j < kMinimalPoints; ++j)
        [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
            [[unroll]] for (uint ky = 0; ky < KH; ++ky)
                if (row >= ky && row - ky < TILE_ROWS)
                    [[unroll]] for (uint v = 0; v < VECTORS; ++v) {
                        float weight = weightOf(u, v, ky * kMinimalPoints + j);
                        [[unroll]] for (uint tile = 0; tile < COLUMN_TILES; ++tile)
                            sum[v * TILE_ROWS + row - ky][tile * kMinimalPoints + j] += weight * point[row][tile][j];
                    }
}

void main()
{
    Strip tile = tileOfGroup(1, 1);
    Target target = targetOf(tile);
    placeRows(int(tile.row * SH) - int(PH), tile, tile.column * SW);
    clearSums();

    uint turns = push.inChannels / U;
    int planeLoads = int(push.source.height * push.source.width / SPAN);
    int plane = 0;
    int texel = firstWeights();
    for (uint turn = 0; turn < turns; ++turn) {
        loadWeights(texel);
        [[unroll]] for (uint u = 0; u < U; ++u) {
            loadWindow(plane);
            if (MINIMAL)
                addPoints(u);
            else
                addTaps(u);
            plane += planeLoads;
        }
        texel += int(WEIGHT_LOADS * kLanes);
    }

    [[unroll]] for (uint v = 0; v < VECTORS; ++v) {
        float bias = biasOf(channelOf(v));
        [[unroll]] for (uint y = 0; y < TILE_ROWS; ++y)
            storeBlock(v * TILE_ROWS + y, target, channelOf(v), tile.row + y, tile.column, bias);
    }
}
