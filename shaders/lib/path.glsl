// One segment of a light path: intersect, emission, next-event estimation, scattering.
// Veach. Robust Monte Carlo Methods for Light Transport Simulation. 1997 (multiple importance sampling)
//
// Surfaces reflect on both sides. They emit on both if the material is doubleSided, else from the front: glTF does not
// show the back of a single-sided surface at all.
//
// The including shader has specialisation constant kFeatures (light_types.h) and names its texel buffers:
//   STRANDLIGHT_BVH_NODE, STRANDLIGHT_BVH_TRIANGLE (lib/trace.glsl), STRANDLIGHT_TEXTURE_WORD, STRANDLIGHT_MATERIAL_TEXEL
//   (lib/textures.glsl), STRANDLIGHT_CORNER(i), STRANDLIGHT_LIGHT_TABLE(i), STRANDLIGHT_ENVIRONMENT(i), and for punctual
//   lights a function-like STRANDLIGHT_PUNCTUAL(i) that gives a GpuLight.
#ifndef STRANDLIGHT_LIB_PATH_GLSL
#define STRANDLIGHT_LIB_PATH_GLSL

#include "lib/path_lights.glsl"
#include "lib/path_scene.glsl"

// From this bounce on, paths end by Russian roulette. On the Cornell box the later start and the square root below have
// 0.6 times the variance-time product of bounce 3 without the root.
const uint kRouletteBounce = 5u;
// An invocation starts no path beyond the first mark and abandons one at the second (counted): lavapipe silently ends all
// loops at 65535 trips. The second mark and two rays at their own bound stay well below that.
const uint kTripsPerSegment = kHasTexCoords ? 64u : 4u; // besides its rays
const uint kTripsToStart = 12000u;
const uint kTripsToAbandon = 32000u;

struct Path
{
    vec3 origin;
    vec3 direction;
    vec3 throughput;
    float pdf;       // density with which the last bounce chose the direction
    uint bounce;     // reflections so far
    vec3 radiance;   // gathered so far, without `sky`
    vec3 sky;        // the environment as the primary ray sees it
    bool alive;
    uint primary;    // of the first hit: 0 not yet, 1 front, 2 back of a single-sided, 3 back of a double-sided, 4 none
    uint item;       // counter of the random numbers: pixel or cell, sample
    uint sampleIndex;
    uint trips;      // of this invocation; survives the path
    uint lost;       // rays or paths given up; survives the path
};

// --- Surfaces ------------------------------------------------------------------------------------------------------

// Material constants times the textures that this scene's kernels know about. `normal` is in tangent space.
Surface surfaceOf(uint material, TextureValues textures, STRANDLIGHT_OUT(vec3) normal)
{
    uint first = material * kMaterialTexels;
    vec3 color = STRANDLIGHT_MATERIAL_TEXEL(first).xyz * textures.baseColor.xyz;
    float metallic = STRANDLIGHT_MATERIAL_TEXEL(first + 1u).w * textures.metallicRoughness.z;
    vec4 specular = STRANDLIGHT_MATERIAL_TEXEL(first + 2u);
    vec4 rest = STRANDLIGHT_MATERIAL_TEXEL(first + 3u);
    vec3 n = 2.0 * textures.normal.xyz - 1.0;
    n = vec3(n.xy * rest.y, n.z);
    float squared = dot(n, n);
    normal = squared > 1e-12 ? n * inversesqrt(squared) : vec3(0.0, 0.0, 1.0);
    Surface surface = makeSurface(color, metallic, rest.x * textures.metallicRoughness.y, specular.w, specular.xyz);
    if (!kHasLayer) {
        surface.f0 = vec3(0.0);
        surface.f90 = 0.0;
    }
    return surface;
}

// --- The path ------------------------------------------------------------------------------------------------------

void startPath(inout Path path, vec3 origin, vec3 direction)
{
    path.origin = origin;
    path.direction = direction;
    path.throughput = vec3(1.0);
    path.pdf = 0.0;
    path.bounce = 0u;
    path.radiance = vec3(0.0);
    path.sky = vec3(0.0);
    path.alive = true;
    path.primary = 0u;
}

void countRounds(inout Path path, Hit hit)
{
    // All lanes of a batch turn together, so the longest ray is what counts.
    path.trips += kTripsPerRound * subgroupMax(hit.rounds);
    path.lost += hit.lost ? 1u : 0u;
}

void addEnvironment(inout Path path, uvec4 header)
{
    ivec2 size = ivec2(STRANDLIGHT_LIGHT_TABLE(1u).xy);
    vec2 uv = environmentUv(path.direction);
    vec3 radiance = path.throughput * environmentRadiance(uv, size);
    float lightPdf = uintBitsToFloat(header.y) *
                     environmentPdf(environmentDensity(uv, header.zw, size), path.direction);
    if (path.bounce == 0u)
        path.sky = radiance;
    else
        path.radiance += radiance * powerHeuristic(path.pdf, lightPdf);
}

void advancePath(inout Path path, PathContext context)
{
    uvec4 header = STRANDLIGHT_LIGHT_TABLE(0u);
    path.trips += kTripsPerSegment;
    Hit hit = traceSurface(context, path.origin, path.direction, 1e30, false);
    countRounds(path, hit);
    if (hit.slot == kNoHit) {
        if (kHasEnvironment && !hit.lost)
            addEnvironment(path, header);
        path.primary = path.primary == 0u ? 4u : path.primary;
        path.alive = false;
        return;
    }

    // Geometry of the hit, turned towards the ray.
    uvec4 c0 = fetchTriangle(hit.slot * 3u);
    uvec4 c1 = fetchTriangle(hit.slot * 3u + 1u);
    uvec4 c2 = fetchTriangle(hit.slot * 3u + 2u);
    vec3 p0 = positionOf(c0);
    vec3 e1 = positionOf(c1) - p0;
    vec3 e2 = positionOf(c2) - p0;
    vec3 position = p0 + e1 * hit.u + e2 * hit.v;
    vec3 geometric = cross(e1, e2);
    geometric *= inversesqrt(max(dot(geometric, geometric), 1e-36));
    float facing = -dot(geometric, path.direction);
    bool front = facing > 0.0;
    geometric = front ? geometric : -geometric;
    uint material = c1.w;
    TexCoords t = fetchTexCoords(hit.slot, hit.u, hit.v, context.triangleCount);
    TextureValues textures = sampleTextures(material, texturesOf(material), t);
    bool doubleSided = (uint(STRANDLIGHT_MATERIAL_TEXEL(material * kMaterialTexels + 3u).w) & kMaterialDoubleSided) != 0u;
    path.primary = path.primary != 0u ? path.primary : (front ? 1u : (doubleSided ? 3u : 2u));

    // Emission, weighted against light sampling finding the same point.
    if (kHasEmitters && (front || doubleSided)) {
        float lightPdf = (1.0 - uintBitsToFloat(header.y)) * uintBitsToFloat(c2.w) * hit.t * hit.t /
                         max(abs(facing), 1e-9);
        float weight = path.bounce == 0u ? 1.0 : powerHeuristic(path.pdf, lightPdf);
        vec3 emission = STRANDLIGHT_MATERIAL_TEXEL(material * kMaterialTexels + 1u).xyz * textures.emissive.xyz;
        path.radiance += path.throughput * emission * weight;
    }
    if (path.bounce >= context.bounces) {
        path.alive = false;
        return;
    }

    // Shading frame: on the viewer's side of both normals.
    uvec4 a0 = STRANDLIGHT_CORNER(hit.slot * 3u);
    uvec4 a1 = STRANDLIGHT_CORNER(hit.slot * 3u + 1u);
    uvec4 a2 = STRANDLIGHT_CORNER(hit.slot * 3u + 2u);
    vec3 normal = unpackDirection(a0.x) * (1.0 - hit.u - hit.v) + unpackDirection(a1.x) * hit.u +
                  unpackDirection(a2.x) * hit.v;
    vec3 mapped;
    Surface surface = surfaceOf(material, textures, mapped);
    if (kHasNormalTexture) {
        vec3 n = normal * inversesqrt(max(dot(normal, normal), 1e-20));
        vec3 tangent = unpackDirection(a0.w & ~1u) * (1.0 - hit.u - hit.v) + unpackDirection(a1.w & ~1u) * hit.u +
                       unpackDirection(a2.w & ~1u) * hit.v;
        tangent -= n * dot(n, tangent);
        tangent *= inversesqrt(max(dot(tangent, tangent), 1e-20));
        vec3 bitangent = cross(n, tangent) * ((a0.w & 1u) != 0u ? -1.0 : 1.0);
        normal = tangent * mapped.x + bitangent * mapped.y + n * mapped.z;
    }
    normal = dot(normal, geometric) < 0.0 ? -normal : normal;
    float squared = dot(normal, normal);
    normal = squared > 1e-12 && dot(normal, path.direction) < 0.0 ? normal * inversesqrt(squared) : geometric;
    vec3 axisX;
    vec3 axisY;
    buildBasis(normal, axisX, axisY);
    vec3 view = -vec3(dot(path.direction, axisX), dot(path.direction, axisY), dot(path.direction, normal));
    vec3 origin = offsetOrigin(context.grid, position, geometric);
    uint dimension = 1u + path.bounce * 3u;

    // Next-event estimation: one light, chosen between the environment and everything else.
    if (kHasEmitters || kHasEnvironment) {
        vec3 pick = uniform3(path.item, path.sampleIndex, dimension + 2u, context.seed);
        vec3 uniforms = uniform3(path.item, path.sampleIndex, dimension + 1u, context.seed);
        float environmentChoice = uintBitsToFloat(header.y);
        LightSample light;
        if (kHasEmitters && kHasEnvironment) {
            LightSample sky = sampleEnvironment(header, ivec2(STRANDLIGHT_LIGHT_TABLE(1u).xy), uniforms, environmentChoice);
            light = sampleEmitter(context, header, origin, uniforms, 1.0 - environmentChoice);
            if (pick.x < environmentChoice)
                light = sky;
        } else if (kHasEnvironment) {
            light = sampleEnvironment(header, ivec2(STRANDLIGHT_LIGHT_TABLE(1u).xy), uniforms, 1.0);
        } else {
            light = sampleEmitter(context, header, origin, uniforms, 1.0);
        }
        vec3 local = vec3(dot(light.direction, axisX), dot(light.direction, axisY), dot(light.direction, normal));
        BrdfValue brdf = evaluateBrdf(surface, view, local);
        bool useful = light.pdf > kSmallestPdf && dot(light.direction, geometric) > 0.0 && luminance(brdf.value) > 0.0 &&
                      luminance(light.radiance) > 0.0;
        // A ray of length zero is a miss at once: lanes without a useful sample do not walk.
        float reach = useful ? light.distanceTo * (1.0 - 1e-4) - context.grid.rayOffset : -1.0;
        Hit blocker = traceSurface(context, origin, light.direction, reach, true);
        countRounds(path, blocker);
        bool visible = useful && blocker.slot == kNoHit && !blocker.lost;
        float weight = light.delta ? 1.0 : powerHeuristic(light.pdf, brdf.pdf);
        vec3 contribution = path.throughput * brdf.value * light.radiance * (weight / max(light.pdf, kSmallestPdf));
        path.radiance += visible ? contribution : vec3(0.0);
    }

    // Scatter.
    vec3 uniforms = uniform3(path.item, path.sampleIndex, dimension, context.seed);
    vec3 local = sampleBrdf(surface, view, uniforms);
    BrdfValue brdf = evaluateBrdf(surface, view, local);
    vec3 direction = axisX * local.x + axisY * local.y + normal * local.z;
    direction *= inversesqrt(max(dot(direction, direction), 1e-20));
    bool scattered = brdf.pdf > kSmallestPdf && dot(direction, geometric) > 0.0;
    path.throughput *= brdf.value / max(brdf.pdf, kSmallestPdf);
    path.pdf = brdf.pdf;
    path.origin = origin;
    path.direction = direction;
    path.bounce += 1u;
    path.alive = scattered;
    if (path.bounce >= kRouletteBounce) {
        float survival = min(sqrt(max(max(path.throughput.x, path.throughput.y), path.throughput.z)), 1.0);
        float u = uniform3(path.item, path.sampleIndex, dimension + 2u, context.seed).y;
        path.alive = path.alive && u < survival;
        path.throughput /= max(survival, kSmallestPdf);
    }
    if (path.alive && path.trips >= kTripsToAbandon) {
        path.alive = false;
        path.lost += 1u;
    }
}

#endif
