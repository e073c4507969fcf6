// values[i] = values[i]^2: the smallest kernel that reads and writes, for samples and tests of the graph.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/sample_types.h"

layout(local_size_x_id = 0) in; // specialisation constant 0: group size
layout(binding = 0, scalar) buffer Values { float values[]; };
layout(push_constant, scalar) uniform Push { SquarePush push; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < push.count)
        values[i] = values[i] * values[i];
}
