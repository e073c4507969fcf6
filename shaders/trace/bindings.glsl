// Names of the bound texel buffers as lib/trace.glsl, lib/textures.glsl and lib/path.glsl want them.
#define STRANDLIGHT_BVH_NODE(i) imageLoad(bvhNodes, int(i))
#define STRANDLIGHT_BVH_TRIANGLE(i) imageLoad(bvhTriangles, int(i))
#define STRANDLIGHT_CORNER(i) imageLoad(corners, int(i))
#define STRANDLIGHT_MATERIAL_TEXEL(i) imageLoad(materials, int(i))
#define STRANDLIGHT_LIGHT_TABLE(i) imageLoad(lightTable, int(i))
#define STRANDLIGHT_TEXTURE_WORD(i) imageLoad(textureWords, int(i)).x
#define STRANDLIGHT_ENVIRONMENT(i) imageLoad(environment, int(i))
#define STRANDLIGHT_PUNCTUAL(i) lights[i]
