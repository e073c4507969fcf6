// Rays against a bounding volume hierarchy, one source for the kernels and their CPU twin.
//
// The tree is stored eight times, once per sign octant of the ray direction, in depth-first order with the nearer
// child first. A ray walks the array forwards: next node on a hit, the node's skip index on a miss. No stack is
// needed, and a node costs one 16-byte fetch.
//   Smits. Efficiency Issues for Ray Tracing. 1998 (skip pointers)
//   Woop, Benthin, Wald. Watertight Ray/Triangle Intersection. 2013 (edge functions shared by neighbours)
#ifndef STRANDLIGHT_SHARED_TRACE_TYPES_H
#define STRANDLIGHT_SHARED_TRACE_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
// Where the tree is: C++ passes it along, GLSL has it bound (lib/trace.glsl).
#define STRANDLIGHT_BVH const BvhView& bvh,
#define STRANDLIGHT_BVH_PASS bvh,
#define STRANDLIGHT_PRECISE
#else
#include "shared/gpu_types.h"
#define STRANDLIGHT_BVH
#define STRANDLIGHT_BVH_PASS
#define STRANDLIGHT_PRECISE precise
#endif

STRANDLIGHT_SHARED_BEGIN

// Boxes are 16-bit integers on a grid over the scene, rounded outwards. Lives in push constants.
struct BvhGrid
{
    vec3 origin;      // world position of grid point 0
    float rayOffset;  // metres per metre: see offsetOrigin()
    vec3 inverseStep; // grid steps per metre
    uint nodeCount;   // nodes of one octant's array; 0: no triangles
};

// Node, 4 words: x = low | high << 16 of the x interval, y and z the same; w = skip index, or for leaves
// kLeafBit | first triangle << 3 | triangle count.
STRANDLIGHT_CONST(uint) kLeafBit = 0x80000000u;
STRANDLIGHT_CONST(uint) kLeafTriangles = 4u;

// Triangle, 3 x 4 words: corner positions and, in the fourth words, the scene's triangle index, the material index
// and, as a float, the density with which light sampling picks a point on it (1/m^2; 0: not an emitter).

// Bounds of one traversal. A step of the outer loop is up to kNodesPerRound nodes and one leaf; lavapipe counts all
// loop trips of an invocation, so the budget is kTripsPerRound * rounds, summed over the rays of an invocation.
STRANDLIGHT_CONST(uint) kNodesPerRound = 8u;
STRANDLIGHT_CONST(uint) kTripsPerRound = 15u; // 8 nodes + 4 triangles + entries of both loops and the round itself
STRANDLIGHT_CONST(uint) kRoundsPerRay = 512u; // a ray that needs more is counted as lost

struct Hit
{
    float t;      // distance along the unit direction; tMax when nothing was hit
    uint slot;    // position in the leaf-ordered triangle array; kNoHit: none
    float u;      // weight of corner 1
    float v;      // weight of corner 2
    uint rounds;  // of the outer loop
    bool lost;    // gave up after kRoundsPerRay
};
STRANDLIGHT_CONST(uint) kNoHit = 0xffffffffu;

#ifdef __cplusplus
struct BvhView
{
    const uvec4* nodes = nullptr;     // [8 * nodeCount]
    const uvec4* triangles = nullptr; // [3 * triangles]
};
inline uvec4 fetchNode(const BvhView& bvh, uint index) { return bvh.nodes[index]; }
inline uvec4 fetchTriangle(const BvhView& bvh, uint index) { return bvh.triangles[index]; }
#else
uvec4 fetchNode(uint index);
uvec4 fetchTriangle(uint index);
#endif

STRANDLIGHT_FN vec3 positionOf(uvec4 corner)
{
    return vec3(uintBitsToFloat(corner.x), uintBitsToFloat(corner.y), uintBitsToFloat(corner.z));
}

// Two unit vectors that complete unit n to a right-handed frame (x, y, n).
// Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin. Building an Orthonormal Basis, Revisited. 2017
STRANDLIGHT_FN void buildBasis(vec3 n, STRANDLIGHT_OUT(vec3) x, STRANDLIGHT_OUT(vec3) y)
{
    float s = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    x = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    y = vec3(b, s + n.y * n.y * a, -n.y);
}

// A zero component would give 0 * inf; 1e-12 is below what a unit direction can resolve over the scene.
STRANDLIGHT_FN float awayFromZero(float v)
{
    return abs(v) < 1e-12f ? (v < 0.0f ? -1e-12f : 1e-12f) : v;
}

STRANDLIGHT_FN float gridLow(uint interval) { return float(interval & 65535u); }
STRANDLIGHT_FN float gridHigh(uint interval) { return float(interval >> 16u); }

// Moves a ray's origin off its surface by a few rounding errors of the hit position. `normal` points to the side
// the ray leaves on.
STRANDLIGHT_FN vec3 offsetOrigin(BvhGrid grid, vec3 position, vec3 normal)
{
    float reach = max(max(abs(position.x), abs(position.y)), abs(position.z));
    return position + normal * max(reach * 7.6e-6f, grid.rayOffset);
}

// The nearest hit with tMin < t < tMax (or, with anyHit, the first one found). direction: unit.
STRANDLIGHT_FN Hit traverse(STRANDLIGHT_BVH BvhGrid grid, vec3 origin, vec3 direction, float tMin, float tMax,
                            bool anyHit)
{
    // The ray on the grid: t of a plane q is q * slope + base.
    vec3 d = vec3(awayFromZero(direction.x), awayFromZero(direction.y), awayFromZero(direction.z));
    vec3 slope = vec3(1.0f) / (d * grid.inverseStep);
    vec3 base = (grid.origin - origin) / d;
    uint octant = (d.x < 0.0f ? 1u : 0u) | (d.y < 0.0f ? 2u : 0u) | (d.z < 0.0f ? 4u : 0u);
    vec3 axisX;
    vec3 axisY;
    buildBasis(direction, axisX, axisY);

    Hit hit;
    hit.t = tMax;
    hit.slot = kNoHit;
    hit.u = 0.0f;
    hit.v = 0.0f;
    hit.rounds = 0u;
    uint node = octant * grid.nodeCount;
    uint end = node + grid.nodeCount;
    while (node < end && hit.rounds < kRoundsPerRay) {
        hit.rounds += 1u;

        // Walk to the next leaf whose box is hit.
        uint leaf = 0u;
        uint visited = 0u;
        while (leaf == 0u && node < end && visited < kNodesPerRound) {
            visited += 1u;
            uvec4 box = fetchNode(STRANDLIGHT_BVH_PASS node);
            float ax = gridLow(box.x) * slope.x + base.x;
            float bx = gridHigh(box.x) * slope.x + base.x;
            float ay = gridLow(box.y) * slope.y + base.y;
            float by = gridHigh(box.y) * slope.y + base.y;
            float az = gridLow(box.z) * slope.z + base.z;
            float bz = gridHigh(box.z) * slope.z + base.z;
            float enter = max(max(min(ax, bx), min(ay, by)), max(min(az, bz), tMin));
            float leave = min(min(max(ax, bx), max(ay, by)), min(max(az, bz), hit.t));
            bool inside = enter <= leave;
            bool isLeaf = box.w >= kLeafBit;
            leaf = inside && isLeaf ? box.w : 0u;
            node = inside || isLeaf ? node + 1u : box.w;
        }

        // Its triangles, projected along the ray: neighbours compute the same edge functions, so no ray slips between.
        uint slot = (leaf & ~kLeafBit) >> 3u;
        uint slotEnd = slot + (leaf & 7u);
        while (slot < slotEnd) {
            vec3 p0 = positionOf(fetchTriangle(STRANDLIGHT_BVH_PASS slot * 3u)) - origin;
            vec3 p1 = positionOf(fetchTriangle(STRANDLIGHT_BVH_PASS slot * 3u + 1u)) - origin;
            vec3 p2 = positionOf(fetchTriangle(STRANDLIGHT_BVH_PASS slot * 3u + 2u)) - origin;
            STRANDLIGHT_PRECISE float x0 = dot(p0, axisX);
            STRANDLIGHT_PRECISE float x1 = dot(p1, axisX);
            STRANDLIGHT_PRECISE float x2 = dot(p2, axisX);
            STRANDLIGHT_PRECISE float y0 = dot(p0, axisY);
            STRANDLIGHT_PRECISE float y1 = dot(p1, axisY);
            STRANDLIGHT_PRECISE float y2 = dot(p2, axisY);
            STRANDLIGHT_PRECISE float e0 = x1 * y2 - y1 * x2;
            STRANDLIGHT_PRECISE float e1 = x2 * y0 - y2 * x0;
            STRANDLIGHT_PRECISE float e2 = x0 * y1 - y0 * x1;
            float det = e0 + e1 + e2;
            bool inside = (e0 >= 0.0f && e1 >= 0.0f && e2 >= 0.0f) || (e0 <= 0.0f && e1 <= 0.0f && e2 <= 0.0f);
            float inverse = 1.0f / det;
            float u = e1 * inverse;
            float v = e2 * inverse;
            float t = e0 * inverse * dot(p0, direction) + u * dot(p1, direction) + v * dot(p2, direction);
            // Written so that a NaN (det = 0) is a miss.
            bool closer = inside && det != 0.0f && t > tMin && t < hit.t;
            hit.t = closer ? t : hit.t;
            hit.slot = closer ? slot : hit.slot;
            hit.u = closer ? u : hit.u;
            hit.v = closer ? v : hit.v;
            node = closer && anyHit ? end : node;
            slot += 1u;
        }
    }
    hit.lost = node < end;
    return hit;
}

STRANDLIGHT_SHARED_END

#endif
