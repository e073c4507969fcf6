// The bandwidth ceiling: a = b + factor c over buffers larger than the caches. Counted as 12 bytes an element.
// McCalpin. Memory Bandwidth and Machine Balance in Current High Performance Computers. 1995
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/bench_types.h"

layout(local_size_x = 64) in;
layout(binding = 0, r32f) uniform readonly imageBuffer b;
layout(binding = 1, r32f) uniform readonly imageBuffer c;
layout(binding = 2, scalar) writeonly buffer A { float a[]; };
layout(push_constant, scalar) uniform Push { BenchTriadPush push; };

void main()
{
    // Sixty-four neighbours own sixty-four neighbouring elements, kBenchTriadTile times.
    uint first = gl_WorkGroupID.x * 64u * kBenchTriadTile + gl_LocalInvocationID.x;
    [[unroll]] for (uint j = 0; j < kBenchTriadTile; ++j) {
        int i = int(first + j * 64u);
        a[i] = imageLoad(b, i).x + push.factor * imageLoad(c, i).x;
    }
}
