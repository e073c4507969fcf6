// Strands, opaque triangles and lights on the device, as the hair passes fetch them
// (shaders/shared/hair_types.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/camera.hpp"
#include "engine/scene/hair.hpp"
#include "engine/scene/scene.hpp"
#include "engine/vk/buffer.hpp"
#include "engine/vk/context.hpp"
#include "passes/hair_lights.hpp"
#include "shaders/shared/hair_types.h"

namespace strandlight {

struct HairBuffers
{
    Buffer points;     // vec4 [points]
    Buffer tangents;   // vec4 [points]
    Buffer colors;     // vec4 [points]
    Buffer segments;   // uvec2 [segments], of the drawn strands alone
    Buffer shaded;     // vec4 [points], written by the shading pass
    Buffer surface;    // vec4 [triangles, 3, 2]; not valid without opaque triangles
    Buffer visibility; // vec4 [triangles, 3], 1 until the shading passes; beside surface
    Buffer lights;     // HairLight [lights]; one zeroed element without any
    Buffer lobes;      // HairLobe [lobes]; the same
    Buffer openness;   // vec4 [points], and
    Buffer along;      // HairLight [mapped lobes, then directions of openness]; only with lobes
    Buffer sparse;     // uvec2 [sparseSegments], of at most 4,096 strands, for openness
    std::vector<gpu::HairLight> alongLights;

    std::uint32_t pointCount = 0;
    std::uint32_t segmentCount = 0;
    std::uint32_t strandCount = 0;   // drawn
    std::uint32_t triangleCount = 0; // opaque
    float widthScale = 1.0f;         // strands over drawn strands
    std::uint32_t sparseSegments = 0;
    float sparseScale = 1.0f; // strands over those of `sparse`
};

// Unit tangents towards the tip, [points]: central differences, one-sided at both ends.
std::vector<glm::vec3> hairTangents(const HairStrands& hair);

// Draws every lod-th strand. `opaque` may be null.
HairBuffers uploadHair(Context& context, const HairStrands& hair, const Scene* opaque,
                       std::span<const gpu::HairLight> lights, std::uint32_t lod);

// Depth range of hair and opaque triangles together.
DepthRange hairDepthRange(const HairStrands& hair, const Scene* opaque, const Camera& camera);

// How the network sees depth: (depth - offset) * scale is 0 at the front of the hair's bounding
// sphere and 1 at its back.
struct HairDepthScale
{
    float offset = 0.0f; // metres
    float scale = 1.0f;  // per metre
};
HairDepthScale hairDepthScale(const HairStrands& hair, const Camera& camera);

// Every how many strands: so many that the drawn ones have about 0.15 pixels of width at the
// bounds' centre, but never fewer than 4,096 strands, nor wider than 16 times.
std::uint32_t automaticHairLod(const HairStrands& hair, const Camera& camera, std::uint32_t height);

} // namespace strandlight
