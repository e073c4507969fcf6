// The weights of a layer in the order in which the row kernels deal them out (conv_rows.glsl): whole texels for each loop
// turn of each block, [block of channels][row phase][turn] x [input channel of the turn][channel of the block][tap].
// An invocation packs one texel; what no weight belongs to is zero. For minimal_filter.h a row's taps are replaced by the
// weights at its points, those of a column phase after those of another.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/minimal_filter.h"
#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, r32f) uniform readonly imageBuffer parameters;
layout(binding = 1, scalar) writeonly buffer Packed { vec4 packed[]; };
layout(push_constant, scalar) uniform Push { ConvPackPush push; };

float weightAt(uint at)
{
    return imageLoad(parameters, int(at)).x;
}

// Of the row of taps that begins at `row`; `point` counts through all its phases.
float weightOfPoint(uint row, uint point)
{
    uint taps = push.kernelWidth / push.columnPhases;
    uint points = minimalPoints(taps);
    uint phase = divide(point, points);
    float w[3];
    [[unroll]] for (uint i = 0; i < 3; ++i) {
        uint column = phase + push.columnPhases * min(i, taps - 1);
        w[i] = weightAt(row + (push.turned != 0 ? push.kernelWidth - 1 - column : column));
    }
    return minimalWeight(taps, point - phase * points, w[0], w[1], w[2]);
}

void main()
{
    uint texel = gl_GlobalInvocationID.x;
    if (texel >= push.texels)
        return;
    uint turn = divide(texel, push.turnTexels);
    uint inTurnTexel = texel - turn * push.turnTexels;
    uint lane = inTurnTexel % push.channelLanes;
    uint first = inTurnTexel / push.channelLanes * 4;
    uint group = divide(turn, push.turns);
    uint block = divide(group, push.phases);
    uint firstTap = (group - block * push.phases + push.paddingHeight) % push.phases;
    vec4 weights;
    [[unroll]] for (uint i = 0; i < 4; ++i) {
        uint inputAndChannel = divide(first + i, push.taps);
        uint inTurn = divide(inputAndChannel, push.laneChannels);
        uint inBlock = (inputAndChannel - inTurn * push.laneChannels) * push.channelLanes + lane;
        uint channel = block * push.laneChannels * push.channelLanes + inBlock;
        uint tap = first + i - inputAndChannel * push.taps;
        uint row = divide(tap, push.rowTaps);
        uint column = tap - row * push.rowTaps;
        if (push.turned != 0) {
            row = push.kernelHeight - 1 - row;
            column = push.columnPhases == 0 ? push.kernelWidth - 1 - column : column;
        }
        bool exists = inTurn < push.turnInputs && channel < push.outChannels;
        uint at = push.weightOffset + channel * push.weightStrideOut +
                  ((turn - group * push.turns) * push.turnInputs + inTurn) * push.weightStrideIn +
                  (firstTap + row * push.phases) * push.kernelWidth;
        at = exists ? at : push.weightOffset;
        float weight;
        if (push.columnPhases == 0)
            weight = weightAt(at + column);
        else
            weight = weightOfPoint(at, column);
        weights[i] = exists ? weight : 0.0;
    }
    packed[texel] = weights;
}
