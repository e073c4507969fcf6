// Weight gradient of a 3x3 convolution of stride 1 on a CPU device, first stage, as conv_weight_quads.comp:
//   strip[s][a,b,ky,kx] = sum over the strip of small[n,a,y,x] large[n,b, y - PH + ky, x - PW + kx]
//
// The nine taps of a tile of four by two pixels are a correlation of small tile and large window: 24 products at points
// (minimal_filter.h along x, its like with the points 0, 1, -1, infinity along y) for 72. Sums stay at the points; the
// taps are read off once a strip.
// Lanes are channels a. A turn takes four pixels of each of TILES in two rows: each lane loads and transforms those of its own channels, and
// one window of eight columns for all, which is handed round by shuffles.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "shared/minimal_filter.h"
#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint A = 2; // vectors of eight channels a
layout(constant_id = 1) const uint B = 4; // channels b: 1, 2, 4 or 8
layout(constant_id = 2) const uint PH = 1;
layout(constant_id = 3) const uint PW = 1;
layout(constant_id = 4) const uint FLAGS = 0;

layout(binding = 0, rgba32f) uniform readonly imageBuffer smallQuads;
layout(binding = 1, rgba32f) uniform readonly imageBuffer largeQuads;
layout(binding = 2, scalar) writeonly buffer Strips { float strips[]; }; // [strip][a,b,ky,kx], or as push says
layout(push_constant, scalar) uniform Push { ConvWeightPush push; };

const uint kLanes = 8;
const bool WHOLE = (FLAGS & kConvWhole) != 0;
const bool SHUFFLE = (FLAGS & kConvShuffle) != 0;
const uint WINDOWS = SHUFFLE ? 1 : kLanes; // of a lane, of the eight of a turn
const uint HALVES = kLanes / B;            // windows of eight columns in a turn, each with two tiles
const uint TILES = 2 * HALVES;             // of a turn, along a row
const uint POINTS = 6, ROW_POINTS = 4;     // along x and y
const uint LEFT = (PW + 3) / 4;            // quads before the pixel that meets a window's first
const uint SKIP = 4 * LEFT - PW;           // floats before the first that a tap reads
const uint QUADS = (SKIP + 10 + 3) / 4;    // of a window's row

float sum[A][B][ROW_POINTS][POINTS];

// Of the rows of a pair, 0 or 1 of them cut off.
void pairPoints(MinimalPoints first, MinimalPoints second, out MinimalPoints points[ROW_POINTS])
{
    points[0] = first;
    [[unroll]] for (uint j = 0; j < POINTS; ++j) {
        points[1].at[j] = first.at[j] + second.at[j];
        points[2].at[j] = first.at[j] - second.at[j];
    }
    points[3] = second;
}

// Of the four rows that the taps of a pair reach.
void windowPoints(MinimalPoints rows[4], out MinimalPoints points[ROW_POINTS])
{
    [[unroll]] for (uint j = 0; j < POINTS; ++j) {
        points[0].at[j] = rows[0].at[j] - rows[2].at[j];
        points[1].at[j] = rows[1].at[j] + rows[2].at[j];
        points[2].at[j] = rows[2].at[j] - rows[1].at[j];
        points[3].at[j] = rows[3].at[j] - rows[1].at[j];
    }
}

void storeTaps(uint at, float m[ROW_POINTS][POINTS])
{
    vec3 row[ROW_POINTS]; // taps kx
    [[unroll]] for (uint i = 0; i < ROW_POINTS; ++i) {
        MinimalPoints points;
        [[unroll]] for (uint j = 0; j < POINTS; ++j)
            points.at[j] = m[i][j];
        row[i] = minimalTaps(points);
    }
    vec3 half1 = 0.5 * (row[1] + row[2]);
    vec3 taps[3] = vec3[3](row[0] + half1, 0.5 * (row[1] - row[2]), half1 + row[3]);
    [[unroll]] for (uint t = 0; t < 9; ++t)
        strips[at + (push.turned != 0 ? 8 - t : t)] = taps[t / 3][t % 3];
}

void main()
{
    // Strips are the slowest index: what a strip reads stays in the cache for all its tiles.
    uint strip = push.firstStrip + gl_WorkGroupID.z;
    uint firstB = gl_WorkGroupID.x * B;
    uint firstA = gl_WorkGroupID.y * A * kLanes;
    uint lane = gl_LocalInvocationID.x;
    // Once: where control flow diverges, each read of a push constant is eight loads on a CPU device.
    // Widths and addresses are in quads.
    int smallHeight = int(push.small.height), smallWidth = int(push.small.width / 4);
    int largeHeight = int(push.large.height), largeWidth = int(push.large.width / 4);
    int smallPlane = smallHeight * smallWidth, largePlane = largeHeight * largeWidth;
    int smallImageStride = int(push.small.imageStride / 4), largeImageStride = int(push.large.imageStride / 4);
    int smallOffset = int(push.small.offset / 4), largeOffset = int(push.large.offset / 4);

    int windowX[WINDOWS], windowAddress[WINDOWS]; // of the first image's first row
    [[unroll]] for (uint w = 0; w < WINDOWS; ++w) {
        uint slot = SHUFFLE ? lane : w;
        windowX[w] = 2 * int(slot % HALVES) - int(LEFT);
        windowAddress[w] = largeOffset + int(min(firstB + slot / HALVES, push.largeChannels - 1)) * largePlane + windowX[w];
    }
    int channelAddress[A];
    [[unroll]] for (uint a = 0; a < A; ++a)
        channelAddress[a] = smallOffset + int(min(firstA + a * kLanes + lane, push.smallChannels - 1)) * smallPlane;

    [[unroll]] for (uint a = 0; a < A; ++a)
        [[unroll]] for (uint b = 0; b < B; ++b)
            [[unroll]] for (uint i = 0; i < ROW_POINTS; ++i)
                [[unroll]] for (uint j = 0; j < POINTS; ++j)
                    sum[a][b][i][j] = 0.0;

    // Pairs of rows are numbered through the batch; one flat loop over their pieces of TILES quads.
    int perRow = (smallWidth + int(TILES) - 1) / int(TILES);
    int perImage = (smallHeight + 1) / 2;
    int pair = int(strip * push.stripLength);
    int pairs = int(push.pixels / (push.small.width * push.small.height)) * perImage;
    int turns = (min(pair + int(push.stripLength), pairs) - pair) * perRow;
    int n = int(divide(uint(pair), uint(perImage)));
    int y = 2 * (pair - n * perImage);
    int x = 0;
    for (int turn = 0; turn < turns; ++turn) {
        int smallRow = n * smallImageStride + y * smallWidth + x;
        MinimalPoints left[A][TILES][ROW_POINTS];
        [[unroll]] for (uint a = 0; a < A; ++a)
            [[unroll]] for (uint tile = 0; tile < TILES; ++tile) {
                MinimalPoints rows[2];
                [[unroll]] for (uint r = 0; r < 2; ++r) {
                    bool inside = WHOLE || (x + int(tile) < smallWidth && y + int(r) < smallHeight);
                    vec4 quad = imageLoad(smallQuads, inside ? channelAddress[a] + smallRow + int(tile) + int(r) * smallWidth : 0);
                    rows[r] = minimalFilter(inside ? quad : vec4(0.0));
                }
                pairPoints(rows[0], rows[1], left[a][tile]);
            }
        MinimalPoints mine[WINDOWS][2][ROW_POINTS];
        [[unroll]] for (uint w = 0; w < WINDOWS; ++w) {
            MinimalPoints rows[2][4];
            [[unroll]] for (uint r = 0; r < 4; ++r) {
                int iy = y + int(r) - int(PH);
                int at = windowAddress[w] + n * largeImageStride + iy * largeWidth + x;
                vec4 quads[QUADS];
                [[unroll]] for (uint q = 0; q < QUADS; ++q) {
                    bool inColumns = WHOLE && q >= LEFT && q < LEFT + 2; // those of the turn itself
                    bool inside = uint(iy) < uint(largeHeight) && (inColumns || uint(x + windowX[w] + int(q)) < uint(largeWidth));
                    vec4 quad = imageLoad(largeQuads, inside ? at + int(q) : 0);
                    quads[q] = inside ? quad : vec4(0.0); // a select, not a product: NaN must not leak in
                }
                [[unroll]] for (uint tile = 0; tile < 2; ++tile) {
                    float inputs[6];
                    [[unroll]] for (uint j = 0; j < 6; ++j)
                        inputs[j] = quads[(SKIP + 4 * tile + j) / 4][(SKIP + 4 * tile + j) % 4];
                    rows[tile][r] = minimalInputs(inputs);
                }
            }
            [[unroll]] for (uint tile = 0; tile < 2; ++tile)
                windowPoints(rows[tile], mine[w][tile]);
        }
        // What is loaded of `left` serves all b.
        [[unroll]] for (uint i = 0; i < ROW_POINTS; ++i)
            [[unroll]] for (uint j = 0; j < POINTS; ++j)
                [[unroll]] for (uint b = 0; b < B; ++b)
                    [[unroll]] for (uint tile = 0; tile < TILES; ++tile) {
                        uint slot = b * HALVES + tile / 2;
                        float right = SHUFFLE ? subgroupShuffle(mine[0][tile % 2][i].at[j], slot) : mine[slot][tile % 2][i].at[j];
                        [[unroll]] for (uint a = 0; a < A; ++a)
                            sum[a][b][i][j] += left[a][tile][i].at[j] * right;
                    }
        // The next piece, by counting: integer division has no vector form on a CPU.
        x += int(TILES);
        bool newPair = x >= smallWidth;
        x = newPair ? 0 : x;
        y += newPair ? 2 : 0;
        bool newImage = y >= smallHeight;
        y = newImage ? 0 : y;
        n += newImage ? 1 : 0;
    }

    [[unroll]] for (uint a = 0; a < A; ++a) {
        uint channel = firstA + a * kLanes + lane;
        [[unroll]] for (uint b = 0; b < B; ++b)
            if (channel < push.smallChannels && firstB + b < push.largeChannels)
                storeTaps(strip * push.stripStride + channel * push.strideSmall + (firstB + b) * push.strideLarge, sum[a][b]);
    }
}
