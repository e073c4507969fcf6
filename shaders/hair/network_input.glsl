// What the filter network reads of a pixel (kHairInputPlanes of hair_types.h), from the samples of the features and shape
// images and the blended hair. Past the picture's border the planes say "no hair".
#ifndef STRANDLIGHT_HAIR_NETWORK_INPUT_GLSL
#define STRANDLIGHT_HAIR_NETWORK_INPUT_GLSL

#include "shared/hair_types.h"
#include "nn/nn_math.glsl"

layout(binding = 0) uniform sampler2DMS features; // brightness, illumination, transparency, depth
layout(binding = 1) uniform sampler2DMS shape;    // tangent
layout(binding = BLENDED_BINDING, rgba32f) uniform readonly image2D blended; // premultiplied radiance, transmittance

// Planes come in two parts: what the features hold, and the rest. `part` is to be a constant.
const uint kParts = 2;

// Planes [16 part, 16 part + 16) of a pixel of the planes, as far as they exist.
void networkInput(HairPlaneSource from, ivec2 pixel, uint part, out float values[kHairPartPlanes])
{
    ivec2 at = ivec2(pixel.x, pixel.y + int(from.firstRow));
    bool inside = at.x < int(from.width) && at.y < int(from.height);
    at = inside ? at : ivec2(0);
    if (part == 0) {
        [[unroll]] for (int s = 0; s < 4; ++s) {
            vec4 value = inside ? texelFetch(features, at, s) : vec4(0.0, 0.0, 1.0, 0.0);
            values[s] = nnLog1p(value.x < 0.0 ? 0.0 : value.x);
            values[4 + s] = value.y;
            values[8 + s] = value.z;
            values[12 + s] = value.z < 0.5 ? (value.w - from.depthOffset) * from.depthScale : 0.0;
        }
        return;
    }
    [[unroll]] for (int s = 0; s < 4; ++s) {
        // The tangent's sign says where the root is, which must not matter: the double angle. (0,0) without hair.
        vec2 along = inside ? texelFetch(shape, at, s).xy : vec2(0.0);
        values[s] = along.x * along.x - along.y * along.y;
        values[4 + s] = 2.0 * along.x * along.y;
    }
    vec4 mean = inside ? imageLoad(blended, at) : vec4(0.0, 0.0, 0.0, 1.0);
    values[kHairInputExact - kHairPartPlanes] = mean.a;
    values[kHairInputBlended - kHairPartPlanes] = nnLog1p(dot(mean.rgb, vec3(0.2126, 0.7152, 0.0722)));
}

#endif
