// What the convolutions share whose lanes are output channels; behind conv_rows.glsl and the constants INPUT_ROWS, rows of
// pixels that a tile reads, and TILE_ROWS, those of the grid that it computes.
//
// A workgroup of eight lanes computes K channels, K / 8 of a lane, over a tile of TILE_ROWS x NX of the grid. Per input
// channel each lane loads one row of eight, and the weights of its own channels; the rows are handed round by shuffles.
// conv_rows.comp, whose lanes are strips of pixels, hands round the weights instead, of which there are more, and loads
// every pixel once for each tap row; its code is twice as long.
// Without shuffles each lane loads all rows.
#ifndef STRANDLIGHT_NN_CONV_LANES_GLSL
#define STRANDLIGHT_NN_CONV_LANES_GLSL

const bool SHUFFLE = (FLAGS & kConvShuffle) != 0;
const uint ROW_STEP = SHUFFLE ? kLanes : 1;
const uint WH = (INPUT_ROWS + ROW_STEP - 1) / ROW_STEP; // of a lane
const uint VECTORS = K / kLanes;                        // of channels
const uint WEIGHT_LOADS = (U * VECTORS * TAPS + 3) / 4;

#include "nn/conv_window.glsl"

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

// The tile's first row and column of the grid, of which scaleH x scaleW pixels of the result are one place.
Strip tileOfGroup(uint scaleH, uint scaleW)
{
    if ((FLAGS & kConvTiles) != 0) { // of kTileSide x kTileSide pixels
        uint tile = imageLoad(tiles, int(gl_WorkGroupID.x)).x;
        return Strip(0, (tile >> 16) * (kTileSide / scaleH), (tile & 0xffffu) * (kTileSide / scaleW), true);
    }
    uint rows = TILE_ROWS * scaleH;
    uint down = (push.result.height + rows - 1) / rows;
    uint tileRow = push.firstStrip + gl_WorkGroupID.z; // through the images
    uint image = divide(tileRow, down);
    return Strip(image, (tileRow - image * down) * TILE_ROWS, gl_WorkGroupID.y * NX, true);
}

// `firstRow` of the image.
void placeRows(int firstRow, Strip tile, uint column)
{
    placeWindow(firstRow + int(SHUFFLE ? gl_LocalInvocationID.x : 0), int(column), tile.image);
}

// Texel of this lane's first weights.
int firstWeights()
{
    return int((groupOfInvocation() * (push.inChannels / U) * WEIGHT_LOADS) * kLanes + gl_LocalInvocationID.x);
}

// Of vector v.
uint channelOf(uint v)
{
    return groupOfInvocation() * K + v * kLanes + gl_LocalInvocationID.x;
}

#endif
