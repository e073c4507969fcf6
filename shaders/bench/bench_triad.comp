// The bandwidth ceiling: a = b + factor c over buffers larger than the caches. Counted as 12 bytes an element.
// McCalpin. Memory Bandwidth and Machine Balance in Current High Performance Computers. 1995
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/bench_types.h"

// The fastest of the forms tried on lavapipe: four texels at once, one element an invocation, large groups.
layout(local_size_x = 256) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer b;
layout(binding = 1, rgba32f) uniform readonly imageBuffer c;
layout(binding = 2, scalar) writeonly buffer A { vec4 a[]; };
layout(push_constant, scalar) uniform Push { BenchTriadPush push; };

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    a[i] = imageLoad(b, i) + push.factor * imageLoad(c, i);
}
