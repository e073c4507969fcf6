// What the hair passes share: push constants, lights, and how strands lie in texel buffers.
//   points   rgba32f [points]    position, true radius in metres
//   tangents rgba32f [points]    unit tangent towards the tip
//   colors   rgba32f [points]    linear albedo
//   shaded   rgba32f [points]    radiance towards the camera, share of the lights that arrives
//   openness rgba32f [points]    first moment and mean of the visibility over the sphere
//   segments rg32ui  [segments]  first of the segment's two points, strand
//   surface  rgba32f [opaque triangles, 3, 2]  position, albedo as unorm bytes | unit normal, 0
//   visibility rgba32f [opaque triangles, 3]   share of lights 0 to 3 that hair lets through
#ifndef STRANDLIGHT_SHARED_HAIR_TYPES_H
#define STRANDLIGHT_SHARED_HAIR_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#include "shaders/shared/nn_types.h"
#else
#include "shared/gpu_types.h"
#include "shared/nn_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

struct HairStrandPush
{
    mat4 viewProjection; // world to Vulkan clip space
    vec2 size;           // of the target in pixels
    vec2 jitter;         // pixels, added to every position
    float pixelsPerUnit; // of a length of 1 m at clip w = 1
    float widthScale;    // drawn strands stand for this many
    float minimumWidth;  // pixels: 1 where alpha makes up for the width, 0 for true width
    float alpha;         // of a strand that covers its pixel
    uint frame;          // of the sample masks
};

// Slices of depth that strands are blended in; a fragment writes all of them and one image more, which makes the eight that
// every device draws into at once.
STRANDLIGHT_CONST(uint) kHairSlices = 7u;
// Of a blended strand: its logarithm must stay finite.
STRANDLIGHT_CONST(float) kHairMostAlpha = 0.999999f;

struct HairOpaquePush
{
    mat4 viewProjection;
    vec2 size;
    vec2 jitter;
    vec3 ambient;
    uint lightCount;
    uint lobeCount;
};

// A distant lobe of light; the last of a list has sharpness 0: what is the same from everywhere.
struct HairLobe
{
    vec3 axis; // unit, at the light
    float sharpness;
    vec3 energy; // radiance over the lobe, W/m^2 on a plane that faces a sharp one
    float share; // of all illumination
};

// Point and spot lights have a position, directional and spot lights a direction (shared numbering of light_types.h).
struct HairLight
{
    mat4 shadowMatrix; // world to the shadow map's clip space
    vec3 position;
    uint type;         // 0 point, 1 spot, 2 directional
    vec3 direction;    // the way the light travels
    float range;       // 0: infinite
    vec3 intensity;    // candela, or lux
    float innerConeCos;
    float outerConeCos;
    float shadowBias;  // metres towards the light
};

struct HairShadePush
{
    vec3 eye;
    float roughness;
    vec3 ambient;
    float tilt;       // radians
    uint pointCount;
    uint light;       // index; lightCount and more: ambient alone
    uint lightCount;
    uint first;       // 1: starts from the ambient term, 0: adds to `shaded`
    uint shadowSize;
    float share;      // of this light in the illumination
};

// Directions in which the visibility of strand points is taken: the corners of a cube, over which means and first
// moments are exact for visibilities that are linear in the direction.
STRANDLIGHT_CONST(uint) kHairOpenDirections = 8u;

struct HairOpenPush
{
    uint pointCount;
    uint light;      // of the shadow map
    uint first;      // 1: starts anew, 0: adds to `openness`
    uint shadowSize;
};

struct HairLobePush
{
    vec3 eye;
    float roughness;
    float tilt;      // radians
    uint pointCount;
    uint lobe;       // the first one
    uint lobeCount;  // so many from there
    uint first;      // 1: starts anew, 0: adds to `shaded`
    uint shadowSize;
};

// Of so many lights, the first ones, hair casts shadows on opaque triangles.
STRANDLIGHT_CONST(uint) kHairSurfaceLights = 4u;

struct HairSurfacePush
{
    uint cornerCount;
    uint light; // below kHairSurfaceLights
    uint shadowSize;
};

struct HairResolvePush
{
    uint width;
    uint height;
    float weight; // of this frame in the sum
    uint samples; // that are averaged, of four
};

// Planes of the network's input, [26, height, width]: value v of sample s is plane 4 v + s; then the exact transmittance
// and ln(1 + brightness) of the blended radiance. Values: ln(1 + brightness), illumination, transparency, depth, tangent
// as cos and sin of its double angle.
STRANDLIGHT_CONST(uint) kHairInputPlanes = 26u;
STRANDLIGHT_CONST(uint) kHairInputExact = 24u;
STRANDLIGHT_CONST(uint) kHairInputBlended = 25u;

// Where the planes come from.
struct HairPlaneSource
{
    uint firstRow; // of the planes in the picture
    uint width;    // of the picture
    uint height;
    float depthOffset; // planes hold (depth - offset) * scale, 0 without hair
    float depthScale;
};

struct HairInputPush
{
    TensorView planes; // rows of the picture, and past its border
    HairPlaneSource from;
};

// Planes that hair_conv.comp has in shared memory at once.
STRANDLIGHT_CONST(uint) kHairPartPlanes = 16u;

// hair_conv.comp; "strips" are tiles.
struct HairConvPush
{
    ConvRowsPush conv;
    HairPlaneSource from;
};

struct HairTouchedPush
{
    uint width; // of the picture
    uint height;
    uint blocksAcross;
    uint blocksDown;
};

// Planes of the network's output, [12, height, width]: what ln(1 + brightness) is above the blended one, illumination,
// what the transmittance is above the exact one, nine logits of a kernel.
STRANDLIGHT_CONST(uint) kHairOutputs = 12u;
STRANDLIGHT_CONST(uint) kHairOutBrightness = 0u;
STRANDLIGHT_CONST(uint) kHairOutTransmittance = 2u;
// The filtered brightness stays within these, times the blended one.
STRANDLIGHT_CONST(float) kHairLeastBrightness = 0.5f;
STRANDLIGHT_CONST(float) kHairMostBrightness = 2.0f;
STRANDLIGHT_CONST(uint) kHairOutLogits = 3u;

struct HairCompositePush
{
    TensorView y;
    uint width;     // of the picture
    uint height;
    uint firstRow;  // of the picture: rows [firstRow, endRow) are done
    uint endRow;
    uint tensorRow; // of the picture, the tensor's first
};

STRANDLIGHT_SHARED_END

#endif
