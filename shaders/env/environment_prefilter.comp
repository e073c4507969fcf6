// GGX-prefiltered environment: each texel of each level is the mean radiance over a GGX lobe about its direction.
// Karis. Real Shading in Unreal Engine 4. 2013 (normal incidence, cosine weight)
// Krivanek, Colbert. Real-Time Shading with Filtered Importance Sampling. 2008 (pyramid level by sample density)
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/shade_types.h"
#include "shared/sg.h"

layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer pyramid;
layout(binding = 1, rgba32f) uniform writeonly imageBuffer prefiltered;
layout(push_constant, scalar) uniform Push { PrefilterPush push; };
#define ENVIRONMENT_PYRAMID pyramid
#include "env/environment_lookup.glsl"

float radicalInverse(uint bits)
{
    return float(bitfieldReverse(bits) >> 8u) * (1.0 / 16777216.0);
}

void main()
{
    uint item = gl_GlobalInvocationID.x;
    uint texelsPerLevel = kPrefilterWidth * kPrefilterHeight;
    if (item >= texelsPerLevel * kPrefilterLevels) {
        return;
    }
    uint level = item / texelsPerLevel;
    uint texel = item % texelsPerLevel;
    float roughness = float(level + 1u) / float(kPrefilterLevels);
    float alpha2 = roughness * roughness * roughness * roughness;
    vec3 axis = environmentDirection((float(texel % kPrefilterWidth) + 0.5) / float(kPrefilterWidth),
                                     (float(texel / kPrefilterWidth) + 0.5) / float(kPrefilterHeight));
    vec3 x = normalize(cross(abs(axis.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), axis));
    vec3 y = cross(axis, x);

    float texelSolidAngle = 2.0 * kPi * kPi / (float(push.environment.width) * float(push.environment.height));
    vec3 sum = vec3(0.0);
    float weight = 0.0;
    for (uint i = 0u; i < kPrefilterSamples; ++i) {
        // Half vector from the distribution, on a Hammersley set: the same for every texel, so levels are smooth.
        float u = (float(i) + 0.5) / float(kPrefilterSamples);
        float phi = 2.0 * kPi * radicalInverse(i);
        float cosHalf2 = (1.0 - u) / (1.0 + (alpha2 - 1.0) * u);
        float cosHalf = sqrt(cosHalf2);
        float sinHalf = sqrt(max(1.0 - cosHalf2, 0.0));
        float cosLight = 2.0 * cosHalf2 - 1.0;
        if (cosLight <= 0.0) {
            continue;
        }
        float sinLight = 2.0 * cosHalf * sinHalf;
        vec3 light = x * (cos(phi) * sinLight) + y * (sin(phi) * sinLight) + axis * cosLight;

        float d = cosHalf2 * (alpha2 - 1.0) + 1.0;
        float density = alpha2 / (kPi * d * d) * 0.25; // D (n.h) / (4 v.h) with v = n
        float sampleSolidAngle = 1.0 / (float(kPrefilterSamples) * density);
        // One level coarser than the sample's own cell: neighbouring samples overlap.
        float lod = max(0.5 * log2(sampleSolidAngle / texelSolidAngle) + 1.0, 0.0);
        lod = min(lod, float(push.environment.levels - 1u));
        uint low = uint(lod);
        uint high = min(low + 1u, push.environment.levels - 1u);
        vec3 radiance = mix(pyramidRadiance(push.environment, light, low),
                            pyramidRadiance(push.environment, light, high), fract(lod));
        sum += radiance * cosLight;
        weight += cosLight;
    }
    imageStore(prefiltered, int(item), vec4(sum / weight, 1.0));
}
