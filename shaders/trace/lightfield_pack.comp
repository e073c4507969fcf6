#version 460
// Means of a captured slice, packed into the light field; the accumulator is left ready for the next slice.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/path_types.h"
#include "shared/rgb9e5.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CapturePackPush push; };
layout(binding = 0, scalar) buffer Accumulator { vec4 accumulator[]; }; // [cell, 2]
layout(binding = 1, scalar) buffer Radiance { uint radiance[]; };       // RGB9E5 words of the part
layout(binding = 2, scalar) buffer Environment { uint environment[]; }; // the same
layout(binding = 3, scalar) buffer Counters { uint counters[]; };       // [3]: cells outside the packing's range

void main()
{
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= push.cellCount)
        return;
    vec3 mean = accumulator[cell * 2u].xyz / float(push.samples);
    vec3 sky = accumulator[cell * 2u + 1u].xyz / float(push.samples);
    radiance[push.firstWord + cell] = packRgb9e5(mean);
    bool clamps = rgb9e5Clamps(mean);
    if (push.environment != 0u) {
        environment[push.firstWord + cell] = packRgb9e5(sky);
        clamps = clamps || rgb9e5Clamps(sky);
    }
    if (clamps)
        atomicAdd(counters[3], 1u);
    accumulator[cell * 2u] = vec4(0.0);
    accumulator[cell * 2u + 1u] = vec4(0.0);
}
