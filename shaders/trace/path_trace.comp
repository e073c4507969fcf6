#version 460
// A picture by path tracing: each invocation owns a pixel and traces one sample after the other until its share of the
// dispatch is used up. Box pixel filter.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(constant_id = 0) const uint kFeatures = 0u;

#include "shared/nan_bits.h"
#include "shared/path_types.h"
#include "shared/scene_types.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { PathTracePush push; };
layout(binding = 0, scalar) buffer Accumulator { vec4 accumulator[]; }; // [pixel] (sum of radiance, samples)
layout(binding = 1, scalar) buffer Counters { uint counters[]; };       // [kTraceCounters]
layout(binding = 2, rgba32ui) uniform readonly uimageBuffer bvhNodes;
layout(binding = 3, rgba32ui) uniform readonly uimageBuffer bvhTriangles;
layout(binding = 4, rgba32ui) uniform readonly uimageBuffer corners;
layout(binding = 5, rgba32f) uniform readonly imageBuffer materials;
layout(binding = 6, rgba32ui) uniform readonly uimageBuffer lightTable;
layout(binding = 7, r32ui) uniform readonly uimageBuffer textureWords;
layout(binding = 8, rgba32f) uniform readonly imageBuffer environment;
layout(binding = 9, scalar) readonly buffer Lights { GpuLight lights[]; };

#include "trace/bindings.glsl"
#include "lib/path.glsl"

void main()
{
    if (gl_GlobalInvocationID.x >= push.pixelCount)
        return;
    uint pixel = push.firstPixel + gl_GlobalInvocationID.x;
    PathContext context;
    context.grid = push.grid;
    context.triangleCount = push.triangleCount;
    context.seed = push.seed;
    context.bounces = push.bounces;

    vec4 sum = accumulator[pixel];
    uint done = uint(sum.w);
    Path path;
    path.item = pixel;
    path.trips = 0u;
    path.lost = 0u;
    path.alive = false;
    uint rejected = 0u;
    while (path.alive || (done < push.targetSample && path.trips < kTripsToStart)) {
        if (!path.alive) {
            path.sampleIndex = done;
            vec2 jitter = sequencePoint(done, uniform3(pixel, 0u, 0u, push.seed).xy);
            vec2 point = vec2(float(pixel % push.width), float(pixel / push.width)) + jitter;
            startPath(path, push.camera.eye, cameraRayDirection(push.camera, point));
        }
        advancePath(path, context);
        if (!path.alive) {
            vec3 radiance = path.radiance + path.sky;
            bool finite = areFiniteByBits(radiance);
            sum.xyz += finite ? radiance : vec3(0.0);
            rejected += finite ? 0u : 1u;
            done += 1u;
        }
    }
    accumulator[pixel] = vec4(sum.xyz, float(done));
    if (done < push.targetSample)
        atomicAdd(counters[0], 1u);
    if (path.lost > 0u)
        atomicAdd(counters[1], path.lost);
    if (rejected > 0u)
        atomicAdd(counters[2], rejected);
}
