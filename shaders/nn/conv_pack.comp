// The weights of a layer in the order in which the row kernels deal them out (conv_rows.glsl): whole texels for each loop
// turn of each block, [block of channels][row phase][turn] x [input channel of the turn][channel of the block][tap].
// An invocation packs one texel; what no weight belongs to is zero.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, r32f) uniform readonly imageBuffer parameters;
layout(binding = 1, scalar) writeonly buffer Packed { vec4 packed[]; };
layout(push_constant, scalar) uniform Push { ConvPackPush push; };

void main()
{
    uint texel = gl_GlobalInvocationID.x;
    if (texel >= push.texels)
        return;
    uint turn = divide(texel, push.turnTexels);
    uint first = (texel - turn * push.turnTexels) * 4;
    uint group = divide(turn, push.turns);
    uint block = divide(group, push.phases);
    uint firstTap = (group - block * push.phases + push.paddingHeight) % push.phases;
    vec4 weights;
    [[unroll]] for (uint i = 0; i < 4; ++i) {
        uint inputAndChannel = divide(first + i, push.taps);
        uint inTurn = divide(inputAndChannel, push.channels);
        uint channel = block * push.channels + inputAndChannel - inTurn * push.channels;
        uint tap = first + i - inputAndChannel * push.taps;
        uint row = divide(tap, push.kernelWidth);
        uint column = tap - row * push.kernelWidth;
        bool exists = inTurn < push.turnInputs && channel < push.outChannels;
        uint at = push.weightOffset + channel * push.weightStrideOut +
                  ((turn - group * push.turns) * push.turnInputs + inTurn) * push.weightStrideIn +
                  (firstTap + row * push.phases) * push.kernelWidth + column;
        float weight = imageLoad(parameters, int(exists ? at : push.weightOffset)).x;
        weights[i] = exists ? weight : 0.0;
    }
    packed[texel] = weights;
}
