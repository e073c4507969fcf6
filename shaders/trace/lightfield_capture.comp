#version 460
// Light field images: each invocation owns one cell of one texel's hemi-octahedral image and traces its samples.
// The texel is no reflection: what arrives is wanted, so the primary ray has no next-event estimation.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(constant_id = 0) const uint kFeatures = 0u;

#include "shared/nan_bits.h"
#include "shared/path_types.h"
#include "shared/scene_types.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CapturePush push; };
// [cell of the slice, 2]: (sum of radiance, samples), (sum of the environment seen directly, 0)
layout(binding = 0, scalar) buffer Accumulator { vec4 accumulator[]; };
layout(binding = 1, scalar) buffer Counters { uint counters[]; };     // [kTraceCounters]
layout(binding = 2, scalar) buffer Primaries { uint primaries[]; };   // [texel of the slice, kPrimaryKinds]
layout(binding = 3, rgba32f) uniform readonly imageBuffer points;     // CapturePoint [texel]
layout(binding = 4, rgba32ui) uniform readonly uimageBuffer bvhNodes;
layout(binding = 5, rgba32ui) uniform readonly uimageBuffer bvhTriangles;
layout(binding = 6, rgba32ui) uniform readonly uimageBuffer corners;
layout(binding = 7, rgba32f) uniform readonly imageBuffer materials;
layout(binding = 8, rgba32ui) uniform readonly uimageBuffer lightTable;
layout(binding = 9, r32ui) uniform readonly uimageBuffer textureWords;
layout(binding = 10, rgba32f) uniform readonly imageBuffer environment;
layout(binding = 11, scalar) readonly buffer Lights { GpuLight lights[]; };

#include "trace/bindings.glsl"
#include "lib/path.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= push.cellCount)
        return;
    uint sliceCell = push.firstCell + gl_GlobalInvocationID.x;
    uint cellsPerTexel = push.size * push.size;
    uint sliceTexel = sliceCell / cellsPerTexel;
    uint cell = sliceCell % cellsPerTexel;
    uint texel = push.firstTexel + sliceTexel;
    vec3 position = imageLoad(points, int(texel * 4u)).xyz;
    vec3 tangent = imageLoad(points, int(texel * 4u + 1u)).xyz;
    vec3 normal = imageLoad(points, int(texel * 4u + 2u)).xyz;
    vec3 geometric = imageLoad(points, int(texel * 4u + 3u)).xyz;
    vec3 bitangent = cross(normal, tangent);

    PathContext context;
    context.grid = push.grid;
    context.triangleCount = push.triangleCount;
    context.seed = push.seed;
    context.bounces = push.bounces;
    vec3 origin = offsetOrigin(push.grid, position, geometric);

    vec4 sum = accumulator[sliceCell * 2u];
    vec3 skySum = accumulator[sliceCell * 2u + 1u].xyz;
    uint done = uint(sum.w);
    Path path;
    path.item = texel * cellsPerTexel + cell;
    path.trips = 0u;
    path.lost = 0u;
    path.alive = false;
    vec2 shift = uniform3(path.item, 0u, 0u, push.seed).xy;
    uint rejected = 0u;
    uvec4 kinds = uvec4(0u);
    while (path.alive || (done < push.samples && path.trips < kTripsToStart)) {
        bool below = false;
        if (!path.alive) {
            path.sampleIndex = done;
            vec2 uv = (vec2(float(cell % push.size), float(cell / push.size)) + sequencePoint(done, shift)) /
                      float(push.size);
            vec3 d = hemiOctDecode(uv);
            vec3 direction = normalize(tangent * d.x + bitangent * d.y + normal * d.z);
            startPath(path, origin, direction);
            // Below the surface itself nothing arrives: a path without length.
            below = dot(direction, geometric) <= 0.0;
            path.throughput = below ? vec3(0.0) : vec3(1.0);
        }
        advancePath(path, context);
        path.alive = path.alive && !below;
        if (!path.alive) {
            bool finite = areFiniteByBits(path.radiance);
            sum.xyz += finite ? path.radiance : vec3(0.0);
            rejected += finite ? 0u : 1u;
            skySum += path.sky;
            if (!below)
                kinds += uvec4(path.primary == 1u ? 1u : 0u, path.primary == 2u ? 1u : 0u,
                               path.primary == 3u ? 1u : 0u, path.primary == 4u ? 1u : 0u);
            done += 1u;
            path.trips += 1u;
        }
    }
    accumulator[sliceCell * 2u] = vec4(sum.xyz, float(done));
    accumulator[sliceCell * 2u + 1u] = vec4(skySum, 0.0);
    for (uint k = 0u; k < kPrimaryKinds; ++k)
        if (kinds[k] > 0u)
            atomicAdd(primaries[sliceTexel * kPrimaryKinds + k], kinds[k]);
    if (done < push.samples)
        atomicAdd(counters[0], 1u);
    if (path.lost > 0u)
        atomicAdd(counters[1], path.lost);
    if (rejected > 0u)
        atomicAdd(counters[2], rejected);
}
