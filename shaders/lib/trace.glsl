// Rays against the scene. The including shader binds two rgba32ui texel buffers and names them before the include:
//   #define STRANDLIGHT_BVH_NODE(i) imageLoad(bvhNodes, int(i))          // GpuScene::nodes
//   #define STRANDLIGHT_BVH_TRIANGLE(i) imageLoad(bvhTriangles, int(i))  // GpuScene::triangles
#ifndef STRANDLIGHT_LIB_TRACE_GLSL
#define STRANDLIGHT_LIB_TRACE_GLSL

#include "shared/trace_types.h"

uvec4 fetchNode(uint index) { return STRANDLIGHT_BVH_NODE(index); }
uvec4 fetchTriangle(uint index) { return STRANDLIGHT_BVH_TRIANGLE(index); }

// Whether anything lies between origin and origin + tMax * direction. Alpha masks count as solid here; lib/path.glsl
// has the form that looks through them.
bool occluded(BvhGrid grid, vec3 origin, vec3 direction, float tMax)
{
    return traverse(grid, origin, direction, 0.0, tMax, true).slot != kNoHit;
}

#endif
