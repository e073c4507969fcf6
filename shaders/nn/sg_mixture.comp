// radiance[n,d] = sum over lobes of amplitude exp(-sharpness/2 |d - axis|^2), for P directions of an image at once.
// Wang et al. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly imageBuffer lobes;      // [N,L,7] decoded
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, scalar) writeonly buffer Radiance { float radiance[]; };
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

const uint P = 4;

void main()
{
    uint n = push.firstImage + gl_GlobalInvocationID.y;
    if (n >= push.images)
        return;
    uint first = gl_GlobalInvocationID.x / 8 * 8 * P + gl_GlobalInvocationID.x % 8;
    vec3 direction[P];
    vec3 sum[P];
    [[unroll]] for (uint j = 0; j < P; ++j) {
        uint d = min(first + j * 8, push.directions - 1);
        int at = int(n * push.directionImageStride + d * 3);
        direction[j] = vec3(imageLoad(directions, at).x, imageLoad(directions, at + 1).x, imageLoad(directions, at + 2).x);
        sum[j] = vec3(0.0);
    }
    int at = int(n * push.lobes * 7);
    for (uint l = 0; l < push.lobes; ++l, at += 7) {
        vec3 axis = vec3(imageLoad(lobes, at).x, imageLoad(lobes, at + 1).x, imageLoad(lobes, at + 2).x);
        float scale = -0.5 * imageLoad(lobes, at + 3).x;
        vec3 amplitude = vec3(imageLoad(lobes, at + 4).x, imageLoad(lobes, at + 5).x, imageLoad(lobes, at + 6).x);
        [[unroll]] for (uint j = 0; j < P; ++j) {
            vec3 chord = direction[j] - axis;
            sum[j] += amplitude * nnExp(scale * dot(chord, chord));
        }
    }
    [[unroll]] for (uint j = 0; j < P; ++j) {
        uint d = first + j * 8;
        if (d < push.directions) {
            uint to = n * 3 * push.directions + d * push.directionStride;
            radiance[to] = sum[j].x;
            radiance[to + push.channelStride] = sum[j].y;
            radiance[to + 2 * push.channelStride] = sum[j].z;
        }
    }
}
