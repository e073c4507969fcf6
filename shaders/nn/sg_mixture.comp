// radiance[n,d] = sum over lobes of amplitude exp(-sharpness/2 |d - axis|^2), for P directions of an image at once.
// With SHUFFLE, eight lanes load eight lobes and hand them round: a workgroup is eight lanes of one image.
// Wang et al. All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance. 2009
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "nn/sg_lobe.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint SHUFFLE = 0;
layout(binding = 0, r32f) uniform readonly imageBuffer lobes;      // [N,L,7] decoded
layout(binding = 1, r32f) uniform readonly imageBuffer directions; // [N,D,3] or [D,3], unit
layout(binding = 2, scalar) writeonly buffer Radiance { float radiance[]; };
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

const uint P = 4;
const uint kLanes = 8;

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
    int image = int(n * push.lobes * 7);
    for (uint block = 0; block < push.lobes; block += kLanes) {
        float lobe[7];
        if (SHUFFLE != 0) {
            uint own = min(block + gl_SubgroupInvocationID % kLanes, push.lobes - 1);
            [[unroll]] for (int k = 0; k < 7; ++k)
                lobe[k] = imageLoad(lobes, image + int(own) * 7 + k).x;
        }
        [[unroll]] for (uint l = 0; l < kLanes; ++l) {
            // Past the last lobe the last one is read again, with no amplitude.
            bool there = block + l < push.lobes;
            int at = image + int(min(block + l, push.lobes - 1)) * 7;
            float value[7];
            [[unroll]] for (int k = 0; k < 7; ++k) {
                if (SHUFFLE != 0)
                    value[k] = subgroupShuffle(lobe[k], l);
                else
                    value[k] = imageLoad(lobes, at + k).x;
            }
            vec3 axis = vec3(value[0], value[1], value[2]);
            vec3 amplitude = there ? vec3(value[4], value[5], value[6]) : vec3(0.0);
            [[unroll]] for (uint j = 0; j < P; ++j) {
                vec3 chord = direction[j] - axis;
                sum[j] += amplitude * nnExp(-0.5 * value[3] * dot(chord, chord));
            }
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
