// Raw network outputs to lobes: [N,L,7] -> axis (3, unit), sharpness, amplitude (3).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "nn/sg_lobe.glsl"

layout(local_size_x = 32) in;
layout(binding = 0, r32f) uniform readonly imageBuffer raw;
layout(binding = 1, scalar) writeonly buffer Lobes { float lobes[]; };
layout(push_constant, scalar) uniform Push { SgMixturePush push; };

void main()
{
    uint lobe = gl_GlobalInvocationID.x;
    if (lobe >= push.images * push.lobes)
        return;
    int at = int(lobe) * 7;
    vec3 rawAxis = vec3(imageLoad(raw, at).x, imageLoad(raw, at + 1).x, imageLoad(raw, at + 2).x);
    vec3 axis = decodeAxis(rawAxis, rawAxisLength(rawAxis));
    lobes[at] = axis.x;
    lobes[at + 1] = axis.y;
    lobes[at + 2] = axis.z;
    lobes[at + 3] = decodeSharpness(imageLoad(raw, at + 3).x);
    lobes[at + 4] = nnSoftplus(imageLoad(raw, at + 4).x);
    lobes[at + 5] = nnSoftplus(imageLoad(raw, at + 5).x);
    lobes[at + 6] = nnSoftplus(imageLoad(raw, at + 6).x);
}
