// What an exponential costs: chains of the network kernels' own, held against the multiply-add ceiling.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/bench_types.h"
#include "nn/nn_math.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) writeonly buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { BenchLoopPush push; };

void main()
{
    uint id = gl_GlobalInvocationID.x;
    const uint kOctets = kBenchExpChains / 8;
    vec4 chain[kOctets][2];
    [[unroll]] for (uint k = 0; k < kBenchExpChains; ++k)
        chain[k / 8][k / 4 % 2][k % 4] = push.factor * float(k + 1) - float(id & 7u);
    for (uint turn = 0; turn < push.turns; ++turn)
        [[unroll]] for (uint step = 0; step < kBenchExpUnroll; ++step)
            [[unroll]] for (uint k = 0; k < kOctets; ++k) {
                nnExp2Negative(chain[k]);
                chain[k][0] = -chain[k][0];
                chain[k][1] = -chain[k][1];
            }
    float sum = 0.0;
    [[unroll]] for (uint k = 0; k < kBenchExpChains; ++k)
        sum += chain[k / 8][k / 4 % 2][k % 4];
    result[id] = sum;
}
