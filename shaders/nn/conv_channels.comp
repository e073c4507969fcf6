// Convolution on a CPU device, lanes being output channels: of stride 1 or 2, three or more channels in eight.
//
// A workgroup of eight lanes computes K channels, K / 8 of a lane, over a tile of ROWS x NX pixels. Per input channel each
// lane loads one of the eight rows of pixels that the tile reads, and the weights of its own channels; the pixels, or
// their points (minimal_filter.h), are handed round by shuffles. conv_rows.comp, whose lanes are strips of pixels, hands
// round the weights instead and loads every pixel once for each tap row: more shuffles and twice the loads.
// Sums are taken in the order of conv_rows.comp and have its bits.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#define RESULT_WIDE
#include "nn/conv_rows.glsl"

layout(constant_id = 12) const uint ROWS = 8; // of the tile

const bool SHUFFLE = (FLAGS & kConvShuffle) != 0;
const uint INPUT_ROWS = (ROWS - 1) * SH + KH;    // that it reads,
const uint ROW_STEP = SHUFFLE ? kLanes : 1;      // and of which a lane loads each eighth; or all
const uint WH = (INPUT_ROWS + ROW_STEP - 1) / ROW_STEP;
const uint WW = (NX - 1) * SW + KW;
const uint LEFT = PW;

#include "nn/conv_window.glsl"

const uint VECTORS = K / kLanes;                 // of channels
const uint SUM_BLOCKS = VECTORS * ROWS;          // [vector][row]
const uint WEIGHT_LOADS = (U * VECTORS * TAPS + 3) / 4;

#include "nn/conv_sums.glsl"

// What the lane that loaded the row has as x[row / ROW_STEP].
float ofRow(float x, uint row)
{
    return SHUFFLE ? subgroupShuffle(x, row % ROW_STEP) : x;
}

vec4 weights[WEIGHT_LOADS]; // of a turn: [input channel][vector][tap] of this lane

void loadWeights(int first)
{
    [[unroll]] for (uint l = 0; l < WEIGHT_LOADS; ++l)
        weights[l] = imageLoad(packedWeights, first + int(l * kLanes));
}

float weightOf(uint u, uint v, uint tap)
{
    uint e = (u * VECTORS + v) * TAPS + tap;
    return weights[e / 4][e % 4];
}

void addTaps(uint u)
{
    float pixel[INPUT_ROWS][WW];
    [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
        [[unroll]] for (uint x = 0; x < WW; ++x)
            pixel[row][x] = ofRow(window[row / ROW_STEP][x], row);
    [[unroll]] for (uint i = 0; i < SUM_BLOCKS; ++i)
        [[unroll]] for (uint t = 0; t < TAPS; ++t)
            [[unroll]] for (uint n = 0; n < NX; ++n)
                sum[i][n] += weightOf(u, i / ROWS, t) * pixel[i % ROWS * SH + t / KW][n * SW + t % KW];
}

// Rows outermost: three rows of sums at a time fit the registers, and each point is loaded from the stack once.
void addPoints(uint u)
{
    float point[INPUT_ROWS][SW][COLUMN_TILES][POINTS];
    [[unroll]] for (uint i = 0; i < SW * COLUMN_TILES; ++i) {
        MinimalPoints mine[WH];
        [[unroll]] for (uint g = 0; g < WH; ++g)
            mine[g] = pointsOfWindow(g, i / COLUMN_TILES, i % COLUMN_TILES);
        [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
            [[unroll]] for (uint j = 0; j < POINTS; ++j)
                point[row][i / COLUMN_TILES][i % COLUMN_TILES][j] = ofRow(mine[row / ROW_STEP].at[j], row);
    }
    [[unroll]] for (uint j = 0; j < POINTS; ++j)
        [[unroll]] for (uint row = 0; row < INPUT_ROWS; ++row)
            [[unroll]] for (uint ky = 0; ky < KH; ++ky)
                if (row >= ky && (row - ky) % SH == 0 && (row - ky) / SH < ROWS)
                    [[unroll]] for (uint i = 0; i < VECTORS * SW; ++i) {
                        uint v = i / SW, phase = i % SW;
                        float weight = weightOf(u, v, (ky * SW + phase) * POINTS + j);
                        [[unroll]] for (uint tile = 0; tile < COLUMN_TILES; ++tile)
                            sum[v * ROWS + (row - ky) / SH][tile * POINTS + j] += weight * point[row][phase][tile][j];
                    }
}

// Its first row and column.
Strip tileOfGroup()
{
    if ((FLAGS & kConvTiles) != 0) { // of kTileSide x kTileSide
        uint tile = imageLoad(tiles, int(gl_WorkGroupID.x)).x;
        return Strip(0, (tile >> 16) * kTileSide, (tile & 0xffffu) * kTileSide, true);
    }
    uint down = (push.result.height + ROWS - 1) / ROWS;
    uint tileRow = push.firstStrip + gl_WorkGroupID.z; // through the images
    uint image = divide(tileRow, down);
    return Strip(image, (tileRow - image * down) * ROWS, gl_WorkGroupID.y * NX, true);
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    Strip strip = tileOfGroup();
    Target target = targetOf(strip);
    placeWindow(int(strip.row * SH + (SHUFFLE ? lane : 0)) - int(PH), int(strip.column * SW), strip.image);
    clearSums();

    uint turns = push.inChannels / U;
    int planeLoads = int(push.source.height * push.source.width / SPAN);
    int plane = 0;
    int texel = int(groupOfInvocation() * turns * WEIGHT_LOADS * kLanes + lane);
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
        uint channel = groupOfInvocation() * K + v * kLanes + lane;
        float bias = biasOf(channel);
        [[unroll]] for (uint y = 0; y < ROWS; ++y)
            storeBlock(v * ROWS + y, target, channel, strip.row + y, strip.column, bias);
    }
}
