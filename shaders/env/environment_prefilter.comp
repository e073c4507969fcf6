// Prefiltered environment: each texel of each level is the mean radiance over a normalised SG about its direction.
// GGX lobes are sums of four such (shared/sg_specular.h), so reflections keep their shape at grazing views, which the
// usual single lobe of normal incidence does not (Karis. Real Shading in Unreal Engine 4. 2013).
// Jakob. Numerically Stable Sampling of the von Mises-Fisher Distribution on S^2. 2012
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
    float sharpness = exp(kPrefilterStep * float(level)) - 1.0;
    vec3 axis = environmentDirection((float(texel % kPrefilterWidth) + 0.5) / float(kPrefilterWidth),
                                     (float(texel / kPrefilterWidth) + 0.5) / float(kPrefilterHeight));
    vec3 x = normalize(cross(abs(axis.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), axis));
    vec3 y = cross(axis, x);

    float texelSolidAngle = 2.0 * kPi * kPi / (float(push.environment.width) * float(push.environment.height));
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kPrefilterSamples; ++i) {
        // A Hammersley set, the same for every texel, so levels are smooth.
        float u = (float(i) + 0.5) / float(kPrefilterSamples);
        float phi = 2.0 * kPi * radicalInverse(i);
        // 1 - cos of the angle; the fraction u of the lobe lies outside.
        float height = sharpness < 1e-3 ? 2.0 * (1.0 - u)
                                        : -log(u + (1.0 - u) * exp(-2.0 * sharpness)) / sharpness;
        float cosine = clamp(1.0 - height, -1.0, 1.0);
        float sine = sqrt(max(height * (2.0 - height), 0.0));
        vec3 light = x * (cos(phi) * sine) + y * (sin(phi) * sine) + axis * cosine;
        float density = exp(-sharpness * height) / sgIntegral(sharpness);
        // One level coarser than the sample's own cell: neighbouring samples overlap.
        float sampleSolidAngle = 1.0 / (float(kPrefilterSamples) * density);
        float lod = 0.5 * log2(sampleSolidAngle / texelSolidAngle) + 1.0;
        sum += pyramidRadiance(push.environment, environmentUv(light), lod);
    }
    imageStore(prefiltered, int(item), vec4(sum / float(kPrefilterSamples), 1.0));
}
