// The weights of a layer in the order in which the row kernels deal them out (conv_rows.glsl): whole texels for each loop
// turn of each block, [block of channels][row phase][turn] x [input channel of the turn][channel of the block][tap]; of
// conv_lanes.glsl texels by lanes, [turn][texel of a lane][lane], a lane's floats being its channels'.
// An invocation packs one texel; what no weight belongs to is zero. For minimal_filter.h a row's taps are replaced by the
// weights at its points.
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

// Of the row of three taps that begins at `row`.
float weightOfPoint(uint row, uint point)
{
    bool turned = push.turned != 0;
    return minimalWeight(point, weightAt(row + (turned ? 2 : 0)), weightAt(row + 1), weightAt(row + (turned ? 0 : 2)));
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
            column = push.minimal == 0 ? push.kernelWidth - 1 - column : column;
        }
        bool exists = inTurn < push.turnInputs && channel < push.outChannels;
        uint at = push.weightOffset + channel * push.weightStrideOut +
                  ((turn - group * push.turns) * push.turnInputs + inTurn) * push.weightStrideIn +
                  (firstTap + row * push.phases) * push.kernelWidth;
        at = exists ? at : push.weightOffset;
        float weight;
        if (push.minimal == 0)
            weight = weightAt(at + column);
        else
            weight = weightOfPoint(at, column);
        weights[i] = exists ? weight : 0.0;
    }
    packed[texel] = weights;
}
