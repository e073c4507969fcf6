// Every strand's radiance and what it absorbs, added up in slices of depth: within a slice the order of strands does not
// count, and sums have no noise. The transmittance of a slice is exp(-sum), of all slices the exact product of 1 - alpha.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "hair/strand_mask.glsl"
#include "nn/nn_math.glsl"
#include "shared/hair_coverage.h"

layout(location = 0) noperspective in vec3 line;
layout(location = 1) noperspective in vec2 across;
layout(location = 2) flat in vec4 first;
layout(location = 3) flat in vec4 second;
layout(binding = 4) uniform sampler2D firstCuts;  // depths in metres where slices end, rising
layout(binding = 5) uniform sampler2D secondCuts;
layout(location = 0) out vec4 slices[kHairSlices]; // radiance times absorbance, absorbance: to be added

void main()
{
    float alpha = push.alpha * hairStripArea(line.x, line.y, normalize(across));
    float absorbance = nnLog1p(alpha / (1.0 - min(alpha, kHairMostAlpha))); // -ln(1 - alpha)
    vec4 here = mix(first, second, clamp(line.z, 0.0, 1.0));
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 passed = step(texelFetch(firstCuts, pixel, 0), vec4(here.w)) + step(texelFetch(secondCuts, pixel, 0), vec4(here.w));
    uint slice = uint(dot(passed, vec4(1.0)));
    vec4 value = vec4(here.rgb * absorbance, absorbance);
    [[unroll]] for (uint i = 0u; i < kHairSlices; ++i) {
        slices[i] = i == slice ? value : vec4(0.0);
    }
}
