// Alpha of a ribbon's fragment and its sample mask.
#ifndef STRANDLIGHT_HAIR_STRAND_MASK_GLSL
#define STRANDLIGHT_HAIR_STRAND_MASK_GLSL

#include "shared/hair_masks.h"
#include "shared/hair_types.h"

layout(push_constant, scalar) uniform Push { HairStrandPush push; };

// What one pixel's width of strand hides: at true width, all of alpha.
float strandAlpha(float width)
{
    return push.alpha * (push.minimumWidth > 0.0 ? clamp(width / push.minimumWidth, 0.0, 1.0) : 1.0);
}

uint strandMask(uvec2 ids, float width)
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    return hairSampleMask(strandAlpha(width), hairFragmentBits(ids.x, ids.y, pixel.x, pixel.y, push.frame));
}

#endif
