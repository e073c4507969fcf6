// The tiles of a layer that have to be computed, in row-major order, and the arguments of indirect dispatches over them.
// One workgroup: every lane decides a run of tiles, counts, and writes behind the lanes before it, so the order is the
// same every time.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 256) in;
layout(binding = 0, r32ui) uniform readonly uimageBuffer touched; // [blocksDown, blocksAcross] (TouchedBlocks)
layout(binding = 1, scalar) writeonly buffer Tiles { uint tiles[]; };
layout(binding = 2, scalar) writeonly buffer Arguments { uint arguments[]; };
layout(push_constant, scalar) uniform Push { TileListPush push; };

shared uint counts[256];
shared uint touchedBits; // of all blocks

// Bits of a block's eight columns or rows that lie in [low, high).
uint bitsWithin(int block, int low, int high)
{
    int first = clamp(low - 8 * block, 0, 8);
    int end = clamp(high - 8 * block, 0, 8);
    return end > first ? (1u << end) - (1u << first) : 0u;
}

bool needed(uint tile)
{
    int y = int(divide(tile, push.tilesAcross));
    int x = int(tile) - y * int(push.tilesAcross);
    // The output pixels that this tile matters to.
    int left = (x * int(kTileSide) << push.level) - int(push.before);
    int right = ((x + 1) * int(kTileSide) << push.level) + int(push.after);
    int top = int(push.tensorRow) + (y * int(kTileSide) << push.level) - int(push.before);
    int bottom = int(push.tensorRow) + ((y + 1) * int(kTileSide) << push.level) + int(push.after);
    left = max(left, 0);
    right = min(right, 8 * int(push.blocksAcross));
    top = max(top, int(push.firstRow));
    bottom = min(bottom, int(push.endRow));
    for (int by = top >> 3; by < (bottom + 7) >> 3; ++by) {
        uint rows = bitsWithin(by, top, bottom) << 8;
        for (int bx = left >> 3; bx < (right + 7) >> 3; ++bx) {
            uint block = imageLoad(touched, by * int(push.blocksAcross) + bx).x;
            if ((block & rows) != 0u && (block & bitsWithin(bx, left, right)) != 0u)
                return true;
        }
    }
    return false;
}

// A picture without hair ends here.
bool anythingTouched(uint lane)
{
    if (lane == 0u)
        touchedBits = 0u;
    barrier();
    uint bits = 0u;
    for (uint block = lane; block < push.blocksAcross * push.blocksDown; block += 256u)
        bits |= imageLoad(touched, int(block)).x;
    if (bits != 0u)
        atomicOr(touchedBits, bits);
    barrier();
    return touchedBits != 0u;
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    bool anything = anythingTouched(lane);
    uint all = anything ? push.tilesAcross * push.tilesDown : 0u;
    uint run = (all + 255u) >> 8;
    uint first = lane * run;
    uint end = min(first + run, all);
    uint count = 0u;
    for (uint tile = first; tile < end; ++tile)
        count += needed(tile) ? 1u : 0u;
    counts[lane] = count;
    barrier();
    uint at = 0u;
    for (uint before = 0u; anything && before < lane; ++before)
        at += counts[before];
    if (lane == 255u) {
        for (uint i = 0u; i < kTileShares * kTileBlocks; ++i) {
            uint share = i / kTileBlocks;
            arguments[3u * i] = (at + count + (1u << share) - 1u) >> share;
            arguments[3u * i + 1u] = i % kTileBlocks + 1u;
            arguments[3u * i + 2u] = 1u;
        }
        for (uint i = at + count; (i & ((1u << (kTileShares - 1u)) - 1u)) != 0u; ++i)
            tiles[i] = ~0u; // outside of every picture
    }
    for (uint tile = first; tile < end && count > 0u; ++tile) {
        if (needed(tile)) {
            uint y = divide(tile, push.tilesAcross);
            tiles[at++] = tile - y * push.tilesAcross | y << 16;
            --count;
        }
    }
}
