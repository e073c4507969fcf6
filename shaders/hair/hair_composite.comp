// The network's answer over the background. It corrects the blended brightness and transmittance; the colour is
// that of the blended radiance around, weighted by the kernel it predicts. Pixels that no strand touches stay as they are.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hair_types.h"
#include "nn/filter_weights.glsl"
#include "nn/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint TILES = 0; // 1: over a list of tiles

layout(binding = 0, r32f) uniform readonly imageBuffer y;          // [12,H,W]
layout(binding = 1, rgba32f) uniform readonly image2D blended;     // premultiplied radiance, transmittance
layout(binding = 2, rgba32f) uniform writeonly image2D filtered;   // premultiplied radiance, 1 - transmittance
layout(binding = 3, rgba32f) uniform image2D radiance;             // background, then hair over it
layout(binding = 4, r32ui) uniform readonly uimageBuffer tiles;
layout(push_constant, scalar) uniform Push { HairCompositePush push; };

float luminance(vec3 c)
{
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

void main()
{
    ivec2 inTensor = TILES == 0u ? ivec2(gl_GlobalInvocationID.xy) : tilePixel(imageLoad(tiles, int(gl_WorkGroupID.x)).x);
    ivec2 pixel = ivec2(inTensor.x, inTensor.y + int(push.tensorRow));
    if (pixel.x >= int(push.width) || pixel.y < int(push.firstRow) || pixel.y >= int(push.endRow)) {
        return;
    }
    vec4 mean = imageLoad(blended, pixel);
    if (mean.a == 1.0) {
        return;
    }
    int plane = int(push.y.width * push.y.height);
    int at = int(push.y.offset) + inTensor.y * int(push.y.width) + inTensor.x;
    float before = luminance(mean.rgb);
    float brightness = nnExp(nnLog1p(before) + imageLoad(y, at + int(kHairOutBrightness) * plane).x) - 1.0;
    // The network is never asked for more: a wrong answer must not be seen from afar.
    float low = kHairLeastBrightness * before, high = kHairMostBrightness * before;
    brightness = keepNan(brightness, clamp(brightness, low, high));
    float transmittance = mean.a + imageLoad(y, at + int(kHairOutTransmittance) * plane).x;
    transmittance = keepNan(transmittance, clamp(transmittance, 0.0, 1.0));

    float weight[kFilterTaps];
    bool inside[kFilterTaps];
    [[unroll]] for (int k = 0; k < int(kFilterTaps); ++k) {
        ivec2 tap = pixel + ivec2(k % 3 - 1, k / 3 - 1);
        inside[k] = uint(tap.x) < push.width && uint(tap.y) < push.height;
        weight[k] = imageLoad(y, at + (int(kHairOutLogits) + k) * plane).x;
    }
    filterWeights(weight, inside);
    vec3 color = vec3(0.0);
    [[unroll]] for (int k = 0; k < int(kFilterTaps); ++k) {
        ivec2 tap = inside[k] ? pixel + ivec2(k % 3 - 1, k / 3 - 1) : pixel;
        color += weight[k] * imageLoad(blended, tap).rgb;
    }
    float size = luminance(color);
    vec3 hair = size > 0.0 ? color * (brightness / size) : vec3(brightness); // grey where no strand knows better
    imageStore(filtered, pixel, vec4(hair, 1.0 - transmittance));
    imageStore(radiance, pixel, vec4(hair + transmittance * imageLoad(radiance, pixel).rgb, 1.0));
}
