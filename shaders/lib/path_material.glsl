// Materials where a path meets them: full resolution, bilinear. The values are those of lib/textures.glsl; the code is one
// small loop, because compilers of software devices inline every call and take minutes over the trilinear form seven
// times over.
#ifndef STRANDLIGHT_LIB_PATH_MATERIAL_GLSL
#define STRANDLIGHT_LIB_PATH_MATERIAL_GLSL

#include "lib/textures.glsl"

struct TexCoords
{
    vec2 uv0;
    vec2 uv1;
};

// `i` is at most one period outside.
int wrapNear(int i, int size, uint mode)
{
    int period = mode == 2u ? 2 * size : size;
    int m = i < 0 ? i + period : (i >= period ? i - period : i);
    m = m < size ? m : period - 1 - m;
    return mode == 1u ? clamp(i, 0, size - 1) : m;
}

// Coordinate without whole periods; what is clamped stays near.
float foldCoordinate(float u, uint mode)
{
    float period = mode == 2u ? 2.0 : 1.0;
    return mode == 1u ? clamp(u, -2.0, 3.0) : u - period * floor(u / period);
}

// The texture of a slot whose two texels start at `texel`, finest level.
vec4 sampleSlotFull(uint texel, TexCoords t)
{
    vec4 a = STRANDLIGHT_MATERIAL_TEXEL(texel);
    vec4 b = STRANDLIGHT_MATERIAL_TEXEL(texel + 1u);
    vec3 uv = vec3(b.w > 0.5 ? t.uv1 : t.uv0, 1.0);
    uint record = uint(max(a.w, 0.0)) * kTextureRecordWords;
    uint sizeWord = STRANDLIGHT_TEXTURE_WORD(record);
    uint flags = STRANDLIGHT_TEXTURE_WORD(record + 1u);
    uint start = STRANDLIGHT_TEXTURE_WORD(record + 3u);
    ivec2 size = max(ivec2(int(sizeWord & 0xffffu), int(sizeWord >> 16u)), ivec2(1));
    uint modeU = (flags >> 8u) & 3u;
    uint modeV = (flags >> 10u) & 3u;
    vec2 p = vec2(foldCoordinate(dot(a.xyz, uv), modeU), foldCoordinate(dot(b.xyz, uv), modeV)) * vec2(size) - 0.5;
    vec2 base = floor(p);
    vec2 f = p - base;
    vec4 sum = vec4(0.0);
    [[dont_unroll]] for (uint corner = 0u; corner < 4u; ++corner) {
        uint i = corner & 1u;
        uint j = corner >> 1u;
        int x = wrapNear(int(base.x) + int(i), size.x, modeU);
        int y = wrapNear(int(base.y) + int(j), size.y, modeV);
        vec4 c = unpackUnorm4x8(STRANDLIGHT_TEXTURE_WORD(start + uint(y * size.x + x)));
        vec3 linear = vec3(srgbToLinear(c.x), srgbToLinear(c.y), srgbToLinear(c.z));
        c.xyz = (flags & 0x1000u) != 0u ? linear : c.xyz;
        sum += c * ((i != 0u ? f.x : 1.0 - f.x) * (j != 0u ? f.y : 1.0 - f.y));
    }
    return sum;
}

// What the textures of a material say, each 1 (the normal: undisturbed) where there is none.
struct TextureValues
{
    vec4 baseColor;
    vec4 metallicRoughness;
    vec4 normal; // as stored, [0, 1]
    vec4 emissive;
};

// `wanted`: kMaterial... texture bits.
TextureValues sampleTextures(uint material, uint wanted, TexCoords t)
{
    TextureValues values;
    values.baseColor = vec4(1.0);
    values.metallicRoughness = vec4(1.0);
    values.normal = vec4(0.5, 0.5, 1.0, 1.0);
    values.emissive = vec4(1.0);
    uint first = material * kMaterialTexels + 4u;
    // One turn per texture that the material has: usually none or one.
    [[dont_unroll]] while (wanted != 0u) {
        uint slot = uint(findLSB(wanted));
        wanted &= wanted - 1u;
        vec4 value = sampleSlotFull(first + slot * 2u, t);
        values.baseColor = slot == 0u ? value : values.baseColor;
        values.metallicRoughness = slot == 1u ? value : values.metallicRoughness;
        values.normal = slot == 2u ? value : values.normal;
        values.emissive = slot == 3u ? value : values.emissive;
    }
    return values;
}

#endif
