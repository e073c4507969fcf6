// What the two sliding-window convolutions share: bindings, tile constants, where an invocation works, its weights'
// addresses and what is stored.
//
// A strip is NX neighbouring columns of one row of the grid; the grid is the result for a convolution, and the result
// divided by the stride for a transposed one. One invocation computes K channels of one strip. Strips are numbered
// through rows and images, so that lanes are full whatever the width; under kConvTiles they are numbered through the
// active tiles instead.
#ifndef STRANDLIGHT_NN_CONV_ROWS_GLSL
#define STRANDLIGHT_NN_CONV_ROWS_GLSL

#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint K = 16; // output channels of an invocation
layout(constant_id = 2) const uint NX = 8; // columns of the grid
layout(constant_id = 3) const uint U = 1;  // input channels per loop turn; divides their number
layout(constant_id = 4) const uint KH = 3; // kernel, stride, padding
layout(constant_id = 5) const uint KW = 3;
layout(constant_id = 6) const uint SH = 1;
layout(constant_id = 7) const uint SW = 1;
layout(constant_id = 8) const uint PH = 1;
layout(constant_id = 9) const uint PW = 1;
layout(constant_id = 10) const uint FLAGS = 0;

layout(binding = 0, r32f) uniform readonly imageBuffer inputTensor; // [N,C,H,W]
layout(binding = 1, r32f) uniform readonly imageBuffer parameters;  // weights and biases
layout(binding = 2, r32f) uniform readonly imageBuffer saved;       // kConvDerivative: the activated values
layout(binding = 3, r32ui) uniform readonly uimageBuffer tiles;     // kConvTiles: x | y << 16 of each active tile
layout(binding = 4, scalar) buffer Result { float result[]; };      // [N,K',H',W']
layout(push_constant, scalar) uniform Push { ConvRowsPush push; };

const uint kLanes = 8; // lanes that share a weight load
const uint TAPS = KH * KW;
const uint LOADS = (K * TAPS + kLanes - 1) / kLanes;

struct Strip
{
    uint image, row, column; // of the grid; column is the first of NX
    bool live;
};

// scaleH, scaleW: pixels of the result per row and column of the grid.
Strip stripOfInvocation(uint scaleH, uint scaleW)
{
    Strip strip;
    if ((FLAGS & kConvTiles) != 0) {
        uint perRow = kTileSide / (scaleW * NX); // these are powers of two
        uint perTile = perRow * (kTileSide / scaleH);
        uint tile = imageLoad(tiles, int(gl_GlobalInvocationID.x / perTile)).x;
        uint inTile = gl_GlobalInvocationID.x % perTile;
        strip.image = 0;
        strip.row = (tile >> 16) * (kTileSide / scaleH) + inTile / perRow;
        strip.column = (tile & 0xffffu) * (kTileSide / scaleW) + inTile % perRow * NX;
        strip.live = true;
        return strip;
    }
    uint gridHeight = (push.result.height + scaleH - 1) / scaleH;
    uint gridWidth = (push.result.width + scaleW - 1) / scaleW;
    uint perRow = (gridWidth + NX - 1) / NX;
    uint index = push.firstStrip + gl_GlobalInvocationID.x;
    strip.live = index < push.endStrip;
    index = min(index, push.endStrip - 1); // a dead lane repeats the last strip and stores nothing
    uint row = divide(index, perRow);
    strip.image = divide(row, gridHeight);
    strip.row = row - strip.image * gridHeight;
    strip.column = (index - row * perRow) * NX;
    return strip;
}

uint firstChannelOfInvocation()
{
    return push.firstChannel + gl_WorkGroupID.y * K;
}

// Address of weight (channel, input channel 0, tap); the last block repeats the last channel rather than read past the end.
int weightAddress(uint channel, uint tap)
{
    return int(push.weightOffset + min(channel, push.outChannels - 1) * push.weightStrideOut + tap);
}

// The j-th load of this lane: the K x TAPS weights of an input channel, channel by channel, are dealt to the lanes in turn.
int laneWeightAddress(uint j)
{
    uint e = j * kLanes + gl_SubgroupInvocationID % kLanes;
    return weightAddress(firstChannelOfInvocation() + e / TAPS, e % TAPS);
}

float biasOf(uint channel)
{
    if ((FLAGS & kConvBias) == 0)
        return 0.0;
    return imageLoad(parameters, int(push.biasOffset + min(channel, push.outChannels - 1))).x;
}

void store(Strip strip, uint channel, uint y, uint x, float value)
{
    if (!strip.live || channel >= push.outChannels || y >= push.result.height || x >= push.result.width)
        return;
    uint inImage = (channel * push.result.height + y) * push.result.width + x;
    uint at = push.result.offset + strip.image * push.result.imageStride + inImage;
    if ((FLAGS & kConvAccumulate) != 0)
        value += result[at];
    float sign = value;
    if ((FLAGS & kConvDerivative) != 0)
        sign = imageLoad(saved, int(push.savedOffset + strip.image * push.savedImageStride + inImage)).x;
    result[at] = sign > 0.0 ? value : value * push.slope;
}

#endif
