// From visible triangles to surfaces: the pixel's ray meets its triangle, attributes are interpolated, the material is
// evaluated. Layout of the images: shared/shade_types.h.
// Specialisation constant 0: the scene has second texture coordinates.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/brdf.h"
#include "shared/camera_types.h"
#include "shared/gbuffer_types.h"
#include "shared/sg.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kSecondTexCoord = 0u;
layout(binding = 0, r32ui) uniform readonly uimage2D visibility;
layout(binding = 1, rgba32ui) uniform readonly uimageBuffer triangles;
layout(binding = 2, rgba32ui) uniform readonly uimageBuffer corners;
layout(binding = 3, rgba32f) uniform readonly imageBuffer materials;
layout(binding = 4, r32ui) uniform readonly uimageBuffer textureWords;
layout(binding = 5, rgba32f) uniform readonly imageBuffer atlasCorners;
layout(binding = 6, rgba32f) uniform writeonly image2D positionImage;
layout(binding = 7, rgba32f) uniform writeonly image2D frameImage;
layout(binding = 8, rgba32f) uniform writeonly image2D tangentImage;
layout(binding = 9, rgba32f) uniform writeonly image2D normalImage;
layout(binding = 10, rgba32f) uniform writeonly image2D diffuseImage;
layout(binding = 11, rgba32f) uniform writeonly image2D specularImage;
layout(binding = 12, rgba32f) uniform writeonly image2D emissiveImage;
layout(push_constant, scalar) uniform Push { SurfacesPush push; };
#define STRANDLIGHT_TEXTURE_WORD(i) imageLoad(textureWords, int(i)).x
#define STRANDLIGHT_MATERIAL_TEXEL(i) imageLoad(materials, int(i))
#define SCENE_CORNERS corners
#include "gbuffer/vertex_pull.glsl"
#include "lib/textures.glsl"

// Weights of corners 1 and 2 where the ray eye + t d meets the triangle's plane (Moeller and Trumbore 1997).
vec2 planeBarycentric(vec3 d, vec3 toFirst, vec3 edge1, vec3 edge2)
{
    vec3 p = cross(d, edge2);
    float determinant = dot(edge1, p);
    float inverse = 1.0 / (abs(determinant) > 1e-30 ? determinant : 1e-30);
    vec3 q = cross(toFirst, edge1);
    return vec2(dot(toFirst, p), dot(d, q)) * inverse;
}

vec2 mixCorners(vec2 a, vec2 b, vec2 c, vec2 weights)
{
    return a + (b - a) * weights.x + (c - a) * weights.y;
}

vec3 mixCorners(vec3 a, vec3 b, vec3 c, vec2 weights)
{
    return a + (b - a) * weights.x + (c - a) * weights.y;
}

// Some unit vector orthogonal to unit n.
vec3 perpendicular(vec3 n)
{
    return normalize(cross(n, abs(n.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
}

void storeSky(ivec2 pixel)
{
    // Later passes look at position.w alone; emission is the picture's starting value.
    imageStore(positionImage, pixel, vec4(0.0));
    imageStore(emissiveImage, pixel, vec4(0.0, 0.0, 0.0, 1.0));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(push.width) || pixel.y >= int(push.height)) {
        return;
    }
    uint visible = imageLoad(visibility, pixel).x;
    if (visible == 0u) {
        storeSky(pixel);
        return;
    }
    uint slot = visible - 1u;
    uvec4 corner0 = imageLoad(triangles, int(3u * slot));
    uvec4 corner1 = imageLoad(triangles, int(3u * slot + 1u));
    uvec4 corner2 = imageLoad(triangles, int(3u * slot + 2u));
    vec3 p0 = uintBitsToFloat(corner0.xyz);
    vec3 edge1 = uintBitsToFloat(corner1.xyz) - p0;
    vec3 edge2 = uintBitsToFloat(corner2.xyz) - p0;

    // Where this pixel's ray and its neighbours' meet the plane.
    vec2 centre = vec2(pixel) + 0.5;
    vec3 toFirst = push.camera.eye - p0;
    vec2 hit = planeBarycentric(cameraRayDirection(push.camera, centre), toFirst, edge1, edge2);
    vec2 right = planeBarycentric(cameraRayDirection(push.camera, centre + vec2(1.0, 0.0)), toFirst, edge1, edge2);
    vec2 below = planeBarycentric(cameraRayDirection(push.camera, centre + vec2(0.0, 1.0)), toFirst, edge1, edge2);
    // Raster rounding can put the centre just outside an edge; attributes must not be extrapolated.
    vec2 weights = clamp(hit, 0.0, 1.0);
    weights *= min(1.0, 1.0 / max(weights.x + weights.y, 1e-6));
    vec3 position = p0 + edge1 * weights.x + edge2 * weights.y;
    vec3 view = normalize(push.camera.eye - position);

    uvec4 a0 = imageLoad(corners, int(3u * slot));
    uvec4 a1 = imageLoad(corners, int(3u * slot + 1u));
    uvec4 a2 = imageLoad(corners, int(3u * slot + 2u));
    vec3 geometric = safeNormalize(cross(edge1, edge2), vec3(0.0, 1.0, 0.0));
    vec3 frameN = safeNormalize(mixCorners(unpackDirection(a0.x), unpackDirection(a1.x), unpackDirection(a2.x),
                                           weights), geometric);

    // Texture coordinates, and the pixel's width in them: the mean of both axes, in log2.
    vec2 uv00 = uintBitsToFloat(a0.yz);
    vec2 uv01 = uintBitsToFloat(a1.yz);
    vec2 uv02 = uintBitsToFloat(a2.yz);
    vec2 uv0 = mixCorners(uv00, uv01, uv02, weights);
    vec2 dx = mixCorners(uv00, uv01, uv02, right) - mixCorners(uv00, uv01, uv02, hit);
    vec2 dy = mixCorners(uv00, uv01, uv02, below) - mixCorners(uv00, uv01, uv02, hit);
    float lod = 0.25 * (log2(max(dot(dx, dx), 1e-20)) + log2(max(dot(dy, dy), 1e-20)));
    vec2 uv1 = vec2(0.0);
    if (kSecondTexCoord != 0u) {
        uv1 = mixCorners(secondTexCoord(slot, 0u, push.triangleCount), secondTexCoord(slot, 1u, push.triangleCount),
                         secondTexCoord(slot, 2u, push.triangleCount), weights);
    }
    SurfaceMaterial material = evaluateMaterial(corner1.w, uv0, uv1, lod);
    Surface surface = makeSurface(material.baseColor, material.metallic, material.roughness, material.specular,
                                  material.specularColor);

    // Frame of the atlas: N from the vertices, T along growing u, made orthogonal.
    int atlasFirst = int(4u * corner0.w);
    vec4 t0 = imageLoad(atlasCorners, atlasFirst);
    vec4 t1 = imageLoad(atlasCorners, atlasFirst + 1);
    vec4 t2 = imageLoad(atlasCorners, atlasFirst + 2);
    vec4 atlasV = imageLoad(atlasCorners, atlasFirst + 3);
    vec2 place = mixCorners(vec2(t0.w, atlasV.x), vec2(t1.w, atlasV.y), vec2(t2.w, atlasV.z), weights);
    vec3 frameT = mixCorners(t0.xyz, t1.xyz, t2.xyz, weights);
    frameT = safeNormalize(frameT - frameN * dot(frameT, frameN), perpendicular(frameN));

    // Normal map in the material's own tangent frame.
    vec3 normal = frameN;
    if (material.normal.z < 0.99999) {
        vec3 tangent = mixCorners(unpackDirection(a0.w & ~1u), unpackDirection(a1.w & ~1u),
                                  unpackDirection(a2.w & ~1u), weights);
        tangent = safeNormalize(tangent - frameN * dot(tangent, frameN), perpendicular(frameN));
        vec3 bitangent = cross(frameN, tangent) * ((a0.w & 1u) != 0u ? -1.0 : 1.0);
        normal = safeNormalize(tangent * material.normal.x + bitangent * material.normal.y + frameN * material.normal.z,
                               frameN);
    }

    // As the path tracer has it (lib/path.glsl): both sides reflect, only the front of a single-sided surface emits,
    // and a normal that leans away from the viewer gives way to the geometric one.
    bool front = dot(geometric, view) > 0.0;
    geometric = front ? geometric : -geometric;
    bool back = dot(frameN, geometric) < 0.0;
    frameN = back ? -frameN : frameN;
    normal = dot(normal, geometric) < 0.0 ? -normal : normal;
    normal = dot(normal, view) > 0.0 ? normal : geometric;
    vec3 emission = front || material.doubleSided ? material.emissive * push.emission : vec3(0.0);

    imageStore(positionImage, pixel, vec4(position, float(visible)));
    imageStore(frameImage, pixel, vec4(frameN, place.x));
    imageStore(tangentImage, pixel, vec4(frameT, place.y));
    imageStore(normalImage, pixel, vec4(normal, surface.alpha));
    imageStore(diffuseImage, pixel, vec4(surface.diffuse, surface.f90));
    imageStore(specularImage, pixel, vec4(surface.f0, back ? 1.0 : 0.0));
    imageStore(emissiveImage, pixel, vec4(emission, 1.0));
}
