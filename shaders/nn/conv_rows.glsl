// What the sliding-window convolutions share: bindings, tile constants, where an invocation works, its weights and
// what is stored.
//
// A strip is NX neighbouring columns of one row of the grid; the grid is the result for a convolution, and the result
// divided by the stride for a transposed one. One invocation computes K channels of one strip. Strips are numbered
// through rows and images, so that lanes are full whatever the width; under kConvTiles they are numbered through the
// active tiles instead.
//
// Under kConvQuads rows are whole texels of four floats, of which one load costs a CPU device little more than one float.
// With RESULT_WIDE eight floats are stored at once (wide_store.glsl), and what kConvAccumulate adds is loaded by quads.
#ifndef STRANDLIGHT_NN_CONV_ROWS_GLSL
#define STRANDLIGHT_NN_CONV_ROWS_GLSL

#ifdef RESULT_WIDE
#include "nn/wide_store.glsl"
#endif
// A kernel with more bindings or push constants than these says so before it includes this file.
#ifndef GUARD_BINDING
#define GUARD_BINDING 9
#endif
#ifndef MORE_PUSH
#define MORE_PUSH
#endif
#include "nn/elements.glsl"
#include "shared/minimal_filter.h"
#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint K = 16; // output channels of an invocation, or of its eight lanes (conv_lanes.glsl)
layout(constant_id = 2) const uint NX = 8; // columns of the grid
layout(constant_id = 3) const uint U = 1;  // input channels per loop turn; divides their number
layout(constant_id = 4) const uint KH = 3; // kernel, stride, padding
layout(constant_id = 5) const uint KW = 3;
layout(constant_id = 6) const uint SH = 1;
layout(constant_id = 7) const uint SW = 1;
layout(constant_id = 8) const uint PH = 1;
layout(constant_id = 9) const uint PW = 1;
layout(constant_id = 10) const uint PHASES = 1; // workgroups that share the row phases of a transposed convolution
layout(constant_id = 11) const uint FLAGS = 0;

// Bindings 0 and 1 are the input's: conv_window.glsl, or images (hair_conv.comp).
layout(binding = 2, rgba32f) uniform readonly imageBuffer packedWeights; // conv_pack.comp
layout(binding = 3, r32f) uniform readonly imageBuffer parameters;       // biases
layout(binding = 4, SOURCE_TEXEL) uniform readonly imageBuffer saved;    // kConvDerivative: what was activated; kConvContinue: result
layout(binding = 5, SOURCE_QUAD) uniform readonly imageBuffer savedQuads;
layout(binding = 6, r32ui) uniform readonly uimageBuffer tiles; // kConvTiles: x | y << 16 of each active tile
layout(binding = 7, scalar) buffer Result { RESULT_ELEMENT result[]; };  // [N,K',H',W']
#ifdef RESULT_WIDE
layout(binding = 8, scalar) writeonly buffer ResultOctets { u64vec4 resultOctets[]; };
layout(binding = 9, rgba32f) uniform readonly imageBuffer heldQuads; // the result, before it is stored
#else
layout(binding = 8, scalar) buffer ResultQuads { RESULT_QUAD resultQuads[]; };
#endif
layout(push_constant, scalar) uniform Push { ConvRowsPush push; MORE_PUSH };

const uint kLanes = 8; // lanes that share a weight load
const bool MINIMAL = (FLAGS & kConvMinimal) != 0;                     // KW is 3, SW 1
const uint TAPS = KH * (MINIMAL ? kMinimalPoints : KW) / PHASES; // weights of an input channel
const uint TURN_TEXELS = (U * K * TAPS + 3) / 4; // of packed weights
const uint LOADS = (TURN_TEXELS + kLanes - 1) / kLanes;

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
    uint index = push.firstStrip + gl_WorkGroupID.y * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    strip.live = index < push.endStrip;
    index = min(index, push.endStrip - 1); // a dead lane repeats the last strip and stores nothing
    uint row = divide(index, perRow);
    strip.image = divide(row, gridHeight);
    strip.row = row - strip.image * gridHeight;
    strip.column = (index - row * perRow) * NX;
    return strip;
}

// Block of channels and row phase, the latter counting faster.
uint groupOfInvocation()
{
    return push.firstGroup + ((FLAGS & kConvTiles) != 0 ? gl_WorkGroupID.y : gl_WorkGroupID.x);
}

// The weights of a loop turn, a texel to each lane in turn.
vec4 dealt[LOADS];

void dealWeights(int turnTexel)
{
    if ((FLAGS & kConvShuffle) != 0)
        [[unroll]] for (uint j = 0; j < LOADS; ++j) {
            uint texel = min(j * kLanes + gl_SubgroupInvocationID % kLanes, TURN_TEXELS - 1);
            dealt[j] = imageLoad(packedWeights, turnTexel + int(texel));
        }
}

float dealtWeight(int turnTexel, uint e)
{
    uint texel = e / 4;
    if ((FLAGS & kConvShuffle) != 0)
        return subgroupShuffle(dealt[texel / kLanes][e % 4], texel % kLanes);
    return imageLoad(packedWeights, turnTexel + int(texel))[e % 4];
}

float biasOf(uint channel)
{
    if ((FLAGS & kConvBias) == 0)
        return 0.0;
    return imageLoad(parameters, int(push.biasOffset + min(channel, push.outChannels - 1))).x;
}

// Where an invocation stores. Read once: where control flow diverges, a push constant is eight loads on a CPU device.
struct Target
{
    uint height, width, plane, channels, first, firstSaved;
    bool live;
    float slope;
};

Target targetOf(Strip strip)
{
    return Target(push.result.height, push.result.width, push.result.height * push.result.width, push.outChannels,
                  push.result.offset + strip.image * push.result.imageStride,
                  push.savedOffset + strip.image * push.savedImageStride, strip.live, push.slope);
}

void storeFloat(Target to, uint channel, uint y, uint x, float value)
{
    if (!to.live || channel >= to.channels || y >= to.height || x >= to.width)
        return;
    uint inImage = channel * to.plane + y * to.width + x;
    if ((FLAGS & kConvAccumulate) != 0)
        value += float(result[to.first + inImage]);
    float sign = value;
    if ((FLAGS & kConvDerivative) != 0)
        sign = imageLoad(saved, int(to.firstSaved + inImage)).x;
    result[to.first + inImage] = RESULT_ELEMENT(guarded(sign > 0.0 ? value : value * to.slope));
}

#ifdef RESULT_WIDE
vec4 accumulated(Target to, uint inImage, vec4 value)
{
    if ((FLAGS & kConvAccumulate) != 0)
        value += imageLoad(heldQuads, int((to.first + inImage) / 4));
    return value;
}
#endif

// Of four neighbouring values, the first at `inImage`.
vec4 activated(Target to, uint inImage, vec4 value)
{
    vec4 sign = value;
    if ((FLAGS & kConvDerivative) != 0)
        sign = imageLoad(savedQuads, int((to.firstSaved + inImage) / 4));
    return mix(value * to.slope, value, greaterThan(sign, vec4(0.0)));
}

#ifdef RESULT_WIDE
// Eight columns from x on, of which all exist or none.
void storeOctet(Target to, uint channel, uint y, uint x, vec4 left, vec4 right)
{
    if (!to.live || channel >= to.channels || y >= to.height || x >= to.width)
        return;
    uint inImage = channel * to.plane + y * to.width + x;
    resultOctets[(to.first + inImage) / 8] =
        asPairs(activated(to, inImage, accumulated(to, inImage, left)),
                activated(to, inImage + 4, accumulated(to, inImage + 4, right)));
}
#else
// Four columns from x on, of which all exist or none.
void storeQuad(Target to, uint channel, uint y, uint x, vec4 value)
{
    if (!to.live || channel >= to.channels || y >= to.height || x >= to.width)
        return;
    uint inImage = channel * to.plane + y * to.width + x;
    if ((FLAGS & kConvAccumulate) != 0)
        value += vec4(resultQuads[(to.first + inImage) / 4]);
    resultQuads[(to.first + inImage) / 4] = RESULT_QUAD(guarded(activated(to, inImage, value)));
}
#endif

#endif
