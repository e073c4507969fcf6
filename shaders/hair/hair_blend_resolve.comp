// The slices over each other, the nearest first: premultiplied radiance, as far as the quarters of the pixel hide what is
// behind, and the transmittance of the quarters' mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "nn/nn_math.glsl"
#include "shared/hair_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D slice0; // radiance times absorbance, absorbance
layout(binding = 1) uniform sampler2D slice1;
layout(binding = 2) uniform sampler2D slice2;
layout(binding = 3) uniform sampler2D slice3;
layout(binding = 4) uniform sampler2D slice4;
layout(binding = 5) uniform sampler2D slice5;
layout(binding = 6) uniform sampler2D slice6;
layout(binding = 7) uniform sampler2D quarters; // absorbance
layout(binding = 8, rgba32f) uniform writeonly image2D blended; // premultiplied radiance, transmittance
layout(push_constant, scalar) uniform Push { HairResolvePush push; };

const float kMost = 65504.0; // what a sum of halves may pass

vec4 under(vec4 nearer, vec4 slice)
{
    if (slice.a == 0.0) {
        return nearer;
    }
    slice = mix(slice, vec4(kMost), greaterThan(slice, vec4(kMost))); // NaN stays
    float through = nnExp(-slice.a);
    return vec4(nearer.rgb + slice.rgb / slice.a * (nearer.a * (1.0 - through)), nearer.a * through);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 sum = vec4(0.0, 0.0, 0.0, 1.0);
    sum = under(sum, texelFetch(slice0, pixel, 0));
    sum = under(sum, texelFetch(slice1, pixel, 0));
    sum = under(sum, texelFetch(slice2, pixel, 0));
    sum = under(sum, texelFetch(slice3, pixel, 0));
    sum = under(sum, texelFetch(slice4, pixel, 0));
    sum = under(sum, texelFetch(slice5, pixel, 0));
    sum = under(sum, texelFetch(slice6, pixel, 0));
    vec4 absorbed = texelFetch(quarters, pixel, 0);
    float through = 0.25 * (nnExp(-absorbed.x) + nnExp(-absorbed.y) + nnExp(-absorbed.z) + nnExp(-absorbed.w));
    float scattered = 1.0 - sum.a; // what strands all over the pixel would hide
    imageStore(blended, pixel, scattered > 0.0 ? vec4(sum.rgb * ((1.0 - through) / scattered), through) : sum);
}
