// Every strand's radiance and what it absorbs, added up in slices of depth: within a slice the order of strands does not
// count, and sums have no noise. The transmittance of a slice is exp(-sum), of all slices the exact product of 1 - alpha.
// Strands are as if scattered over the pixel. Where they are not, as in a dense layer that ends within the pixel, what each
// quarter of it absorbs says more.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "nn/nn_math.glsl"
#include "shared/hair_coverage.h"
#include "shared/hair_types.h"

layout(location = 0) noperspective in vec3 place; // pixels: width, distances from the middle across and along
layout(location = 1) flat in vec3 extent;         // direction, length
layout(location = 2) flat in vec4 first;
layout(location = 3) flat in vec4 second;
layout(binding = 4) uniform sampler2D firstCuts;  // depths in metres where slices end, rising
layout(binding = 5) uniform sampler2D secondCuts;
layout(push_constant, scalar) uniform Push { HairStrandPush push; };
layout(location = 0) out vec4 slices[kHairSlices]; // radiance times absorbance, absorbance: to be added
layout(location = 7) out vec4 quarters;            // absorbance, to be added

float absorbanceOf(float alpha) // -ln(1 - alpha)
{
    return nnLog1p(alpha / (1.0 - min(alpha, kHairMostAlpha)));
}

void main()
{
    vec4 areas = push.alpha * hairQuarterAreas(place.x, place.y, extent.z, place.z, extent.xy);
    float absorbance = absorbanceOf(dot(areas, vec4(0.25)));
    quarters = vec4(absorbanceOf(areas.x), absorbanceOf(areas.y), absorbanceOf(areas.z), absorbanceOf(areas.w));
    vec4 here = mix(first, second, clamp(place.z / max(extent.z, 1e-6) + 0.5, 0.0, 1.0));
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 passed = step(texelFetch(firstCuts, pixel, 0), vec4(here.w)) + step(texelFetch(secondCuts, pixel, 0), vec4(here.w));
    uint slice = uint(dot(passed, vec4(1.0)));
    vec4 value = vec4(here.rgb * absorbance, absorbance);
    [[unroll]] for (uint i = 0u; i < kHairSlices; ++i) {
        slices[i] = i == slice ? value : vec4(0.0);
    }
}
