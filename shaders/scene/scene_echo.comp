// Evaluates scene queries one by one, for the test that compares them with the C++ twins.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, r32ui) uniform readonly uimageBuffer textureWords;
layout(set = 0, binding = 1, rgba32f) uniform readonly imageBuffer materialTexels;
#define STRANDLIGHT_TEXTURE_WORD(i) imageLoad(textureWords, int(i)).x
#define STRANDLIGHT_MATERIAL_TEXEL(i) imageLoad(materialTexels, int(i))
#include "lib/textures.glsl"
#include "shared/environment.h"
#include "shared/scene_echo.h"

layout(set = 0, binding = 2, scalar) readonly buffer Lights { GpuLight lights[]; };
layout(set = 0, binding = 3, scalar) readonly buffer Queries { SceneEchoQuery queries[]; };
layout(set = 0, binding = 4, scalar) writeonly buffer Echoes { SceneEcho echoes[]; };
layout(push_constant, scalar) uniform Push { SceneEchoPush push; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count)
        return;
    SceneEchoQuery q = queries[i];
    SurfaceMaterial m = evaluateMaterial(q.material, q.uv0, q.uv1, q.lod);
    SceneEcho e;
    e.baseColor = vec4(m.baseColor, m.alpha);
    e.emissive = m.emissive;
    e.metallic = m.metallic;
    e.normal = m.normal;
    e.roughness = m.roughness;
    e.specular = m.specularColor * m.specular;
    e.flags = (m.doubleSided ? 1.0 : 0.0) + (m.alphaCutoff >= 0.0 ? 2.0 : 0.0);
    e.environmentUv = environmentUv(q.direction);
    e.environmentDirection = environmentDirection(e.environmentUv.x, e.environmentUv.y);
    vec3 toLight;
    e.irradiance = punctualIrradiance(lights[q.light], q.point, toLight, e.lightDistance);
    e.maskAlpha = evaluateAlpha(q.material, q.uv0, q.uv1);
    echoes[i] = e;
}
