// Direct light of point, spot and directional lights with one shadow ray each; the bake holds only what they cause.
// Specialisation constants: 0 the scene has alpha masks, 1 it has second texture coordinates.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/brdf.h"
#include "shared/scene_types.h"
#include "shared/punctual_types.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kAlphaMask = 0u;
layout(constant_id = 1) const uint kSecondTexCoord = 0u;
layout(binding = 0, rgba32f) uniform readonly image2D positionImage;
layout(binding = 1, rgba32f) uniform readonly image2D normalImage;
layout(binding = 2, rgba32f) uniform readonly image2D diffuseImage;
layout(binding = 3, rgba32f) uniform readonly image2D specularImage;
layout(binding = 4, rgba32ui) uniform readonly uimageBuffer bvhNodes;
layout(binding = 5, rgba32ui) uniform readonly uimageBuffer bvhTriangles;
layout(binding = 6, rgba32ui) uniform readonly uimageBuffer corners;
layout(binding = 7, rgba32f) uniform readonly imageBuffer materials;
layout(binding = 8, r32ui) uniform readonly uimageBuffer textureWords;
layout(binding = 9, scalar) readonly buffer Lights { GpuLight lights[]; };
layout(binding = 10, rgba32f) uniform image2D lit;
layout(push_constant, scalar) uniform Push { PunctualPush push; };
#define STRANDLIGHT_BVH_NODE(i) imageLoad(bvhNodes, int(i))
#define STRANDLIGHT_BVH_TRIANGLE(i) imageLoad(bvhTriangles, int(i))
#define STRANDLIGHT_TEXTURE_WORD(i) imageLoad(textureWords, int(i)).x
#define STRANDLIGHT_MATERIAL_TEXEL(i) imageLoad(materials, int(i))
#define SCENE_CORNERS corners
#include "gbuffer/vertex_pull.glsl"
#include "lib/textures.glsl"
#include "lib/trace.glsl"

bool cutAway(Hit hit)
{
    uint material = fetchTriangle(hit.slot * 3u + 1u).w;
    float cutoff = imageLoad(materials, int(material * kMaterialTexels + 3u)).z;
    if (cutoff < 0.0) {
        return false;
    }
    vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
    vec2 uv0 = vec2(0.0);
    vec2 uv1 = vec2(0.0);
    for (uint k = 0u; k < 3u; ++k) {
        uv0 += weights[k] * uintBitsToFloat(imageLoad(corners, int(3u * hit.slot + k)).yz);
        if (kSecondTexCoord != 0u) {
            uv1 += weights[k] * secondTexCoord(hit.slot, k, push.triangleCount);
        }
    }
    return evaluateAlpha(material, uv0, uv1) < cutoff;
}

bool inShadow(vec3 origin, vec3 direction, float reach)
{
    if (kAlphaMask == 0u) {
        return occluded(push.grid, origin, direction, reach);
    }
    // Holes are passed in order; what is behind too many of them, or takes too long to find, counts as in shadow.
    float nearest = 0.0;
    uint rounds = 0u;
    for (uint layer = 0u; layer < 16u; ++layer) {
        Hit hit = traverse(push.grid, origin, direction, nearest, reach, false);
        if (hit.slot == kNoHit) {
            return hit.lost;
        }
        rounds += hit.rounds;
        if (!cutAway(hit) || rounds > kRoundsPerRay / 2u) {
            return true;
        }
        nearest = hit.t;
    }
    return true;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    vec4 position = imageLoad(positionImage, pixel);
    if (position.w == 0.0) {
        return;
    }
    vec4 normalAlpha = imageLoad(normalImage, pixel);
    vec4 diffuse = imageLoad(diffuseImage, pixel);
    Surface surface;
    surface.diffuse = diffuse.rgb;
    surface.f0 = imageLoad(specularImage, pixel).rgb;
    surface.f90 = diffuse.w;
    surface.alpha = normalAlpha.w;

    uint slot = uint(position.w) - 1u;
    vec3 p0 = positionOf(fetchTriangle(3u * slot));
    vec3 geometric = cross(positionOf(fetchTriangle(3u * slot + 1u)) - p0, positionOf(fetchTriangle(3u * slot + 2u)) - p0);
    geometric *= inversesqrt(max(dot(geometric, geometric), 1e-36));
    vec3 viewWorld = normalize(push.eye - position.xyz);
    geometric = dot(geometric, viewWorld) > 0.0 ? geometric : -geometric;
    vec3 origin = offsetOrigin(push.grid, position.xyz, geometric);

    vec3 x;
    vec3 y;
    buildBasis(normalAlpha.xyz, x, y);
    vec3 view = vec3(dot(viewWorld, x), dot(viewWorld, y), dot(viewWorld, normalAlpha.xyz));
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < push.lightCount; ++i) {
        vec3 toLight;
        float distanceToLight;
        vec3 irradiance = punctualIrradiance(lights[push.firstLight + i], position.xyz, toLight, distanceToLight);
        vec3 local = vec3(dot(toLight, x), dot(toLight, y), dot(toLight, normalAlpha.xyz));
        vec3 contribution = evaluateBrdf(surface, view, local).value * irradiance;
        bool useful = contribution != vec3(0.0) && dot(toLight, geometric) > 0.0;
        if (useful && !inShadow(origin, toLight, distanceToLight * (1.0 - 1e-4))) {
            radiance += contribution;
        }
    }
    imageStore(lit, pixel, vec4(imageLoad(lit, pixel).rgb + radiance, 1.0));
}
