// The arithmetic ceiling that other kernels are held against: chains of multiply-add in registers, no memory.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/bench_types.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) writeonly buffer Result { float result[]; };
layout(push_constant, scalar) uniform Push { BenchLoopPush push; };

void main()
{
    uint id = gl_GlobalInvocationID.x;
    float factor = push.factor + float(id & 7u) * 1e-6;
    float addend = push.addend; // once: in the loop it would be loaded every turn, into a register too many
    float chain[kBenchChains];
    [[unroll]] for (uint k = 0; k < kBenchChains; ++k)
        chain[k] = float(k);
    for (uint turn = 0; turn < push.turns; ++turn)
        [[unroll]] for (uint step = 0; step < kBenchUnroll; ++step)
            [[unroll]] for (uint k = 0; k < kBenchChains; ++k)
                chain[k] = chain[k] * factor + addend;
    float sum = 0.0;
    [[unroll]] for (uint k = 0; k < kBenchChains; ++k)
        sum += chain[k];
    result[id] = sum;
}
