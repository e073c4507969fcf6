// One closed form on many inputs: the device's side of passes/stress.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared/stress_packing.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FUNCTION = 0; // kStress...
layout(binding = 0, scalar) readonly buffer Items { StressInput items[]; };
layout(binding = 1, scalar) writeonly buffer Results { StressOutput results[]; };
layout(push_constant, scalar) uniform Push { uint count; } push;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    if (FUNCTION >= kStressFunctions) {
        results[i] = stressPacking(FUNCTION, items[i]);
    } else {
        results[i] = stressFunction(FUNCTION, items[i]);
    }
}
