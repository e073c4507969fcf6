// Share of a stochastic shadow map's samples about a place that lie behind it. The includer has bound `shadowMap`.
#ifndef STRANDLIGHT_HAIR_SHADOW_MAP_GLSL
#define STRANDLIGHT_HAIR_SHADOW_MAP_GLSL

#include "shared/hair_types.h"

// `reach` texels on each side; outside the map there is no hair.
float shadowMapVisibility(HairLight light, vec3 position, int reach, uint mapSize)
{
    vec4 clip = light.shadowMatrix * vec4(position, 1.0);
    if (!(clip.w > 0.0)) {
        return 1.0;
    }
    vec3 place = clip.xyz / clip.w;
    if (max(abs(place.x), abs(place.y)) > 1.0) {
        return 1.0;
    }
    ivec2 centre = ivec2(floor((place.xy * 0.5 + 0.5) * float(mapSize)));
    int side = 2 * reach + 1;
    int lit = 0;
    for (int tap = 0; tap < side * side; ++tap) {
        ivec2 texel = centre + ivec2(tap % side, tap / side) - reach;
        texel = clamp(texel, ivec2(0), ivec2(int(mapSize) - 1));
        for (int s = 0; s < 4; ++s) {
            lit += texelFetch(shadowMap, texel, s).x >= place.z ? 1 : 0;
        }
    }
    return float(lit) / float(4 * side * side);
}

#endif
