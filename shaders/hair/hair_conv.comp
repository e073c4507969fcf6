// A convolution of the filter network's input that fetches it itself, so that the planes never exist in memory.
//
// A workgroup owns a tile of the result. It fetches each pixel that the tile reads once into shared memory, where its
// strips find their windows: first the planes of the features, then the rest. From there on it is conv_rows.comp, whose
// order of sums and so whose bits it has; at points (minimal_filter.h) those of conv_channels.comp. The two parts are unrolled: a CPU device runs both sides of a branch.
// VARIANT half RESULT_HALF
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#define BLENDED_BINDING 9
#define GUARD_BINDING 10
#define MORE_PUSH HairPlaneSource from;
#include "nn/elements.glsl"
#include "hair/network_input.glsl"
#include "nn/conv_rows.glsl"

// What a tile reads: rows of quads, the first column being that of the leftmost window.
const uint STAGE_ROWS = (kTileSide - 1) * SH + KH;
const uint STAGE_QUADS = ((kTileSide - 1) * SW + KW + 3) / 4;
shared vec4 stage[kHairPartPlanes][STAGE_ROWS * STAGE_QUADS];

const uint WW = (NX - 1) * SW + KW;
float window[KH][WW];

#include "nn/conv_strip.glsl"

uvec2 tileOfGroup()
{
    if ((FLAGS & kConvTiles) != 0) {
        uint tile = imageLoad(tiles, int(gl_WorkGroupID.x)).x;
        return uvec2(tile & 0xffffu, tile >> 16);
    }
    uint across = (push.result.width + kTileSide - 1) / kTileSide;
    uint index = push.firstStrip + gl_WorkGroupID.y;
    uint row = divide(index, across);
    return uvec2(index - row * across, row);
}

void fillStage(uint part, ivec2 origin)
{
    for (uint i = gl_LocalInvocationIndex; i < STAGE_ROWS * STAGE_QUADS; i += gl_WorkGroupSize.x) {
        uint row = i / STAGE_QUADS;
        ivec2 first = origin + ivec2((i - row * STAGE_QUADS) * 4, row);
        vec4 quads[kHairPartPlanes];
        [[unroll]] for (uint c = 0; c < 4; ++c) {
            ivec2 pixel = first + ivec2(c, 0);
            bool inside = uint(pixel.x) < push.source.width && uint(pixel.y) < push.source.height;
            float values[kHairPartPlanes];
            networkInput(from, inside ? pixel : ivec2(0), part, values);
            [[unroll]] for (uint p = 0; p < kHairPartPlanes; ++p)
                quads[p][c] = inside ? values[p] : 0.0;
        }
        [[unroll]] for (uint p = 0; p < kHairPartPlanes; ++p)
            stage[p][i] = quads[p];
    }
}

void loadWindow(uint plane, uint firstQuad)
{
    [[unroll]] for (uint i = 0; i < KH; ++i)
        [[unroll]] for (uint j = 0; j < (WW + 3) / 4; ++j) {
            vec4 quad = stage[plane][firstQuad + i * STAGE_QUADS + j];
            [[unroll]] for (uint c = 0; c < 4; ++c)
                if (j * 4 + c < WW)
                    window[i][j * 4 + c] = quad[c];
        }
}

void continueSums(Strip strip, Target target)
{
    uint firstChannel = groupOfInvocation() * K;
    uint inPlane = min(strip.row, target.height - 1) * target.width;
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint n = 0; n < NX; ++n) {
            uint channel = min(firstChannel + k, target.channels - 1);
            uint column = min(strip.column + n, target.width - 1);
            sum[k][n] = imageLoad(saved, int(target.firstSaved + channel * target.plane + inPlane + column)).x;
        }
}

void main()
{
    const uint perRow = kTileSide / NX;
    uint row = gl_LocalInvocationIndex / perRow, column = gl_LocalInvocationIndex % perRow * NX; // in the tile
    uvec2 tile = tileOfGroup();
    Strip strip = Strip(0, tile.y * kTileSide + row, tile.x * kTileSide + column, true);
    Target target = targetOf(strip);
    ivec2 origin = ivec2(tile * kTileSide * uvec2(SW, SH)) - ivec2(PW, PH);
    uint firstQuad = row * SH * STAGE_QUADS + column * SW / 4;
    if ((FLAGS & kConvContinue) != 0)
        continueSums(strip, target);
    else
        clearSums();

    int weights = int(groupOfInvocation() * kHairInputPlanes * TURN_TEXELS);
    [[unroll]] for (uint part = 0; part < kParts; ++part) {
        barrier(); // the stage has been read
        fillStage(part, origin);
        barrier();
        uint planes = min(kHairPartPlanes, kHairInputPlanes - part * kHairPartPlanes);
        for (uint plane = 0; plane < planes; ++plane) {
            dealWeights(weights);
            loadWindow(plane, firstQuad);
            addWindow(weights, 0);
            weights += int(TURN_TEXELS);
        }
    }
    storeSums(strip, target);
}
