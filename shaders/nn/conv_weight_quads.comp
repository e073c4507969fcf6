// Weight gradient of a convolution on a CPU device, first stage: each invocation sums one strip of rows of
//   strip[s][a,b,ky,kx] = sum over the strip of small[n,a,y,x] large[n,b, y SH - PH + ky, x SW - PW + kx]
// Convolution: small = dY, large = x, a = output, b = input channel. Transposed: small = x, large = dY, a = input, b = output.
//
// Lanes are channels a. A turn takes NX neighbouring pixels of a row: each lane loads those of its own channels, and the
// eight together the B x KH pieces of rows that the taps reach, dealt out by quads (texels of four floats: one load and a
// transposition, where four single floats are four gathers) and handed round by shuffles. Every value handed round meets
// KW taps x A channels. Rows are whole quads (the host sees to it), so a quad is inside the image or outside, never both.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = 8) in;
layout(constant_id = 0) const uint A = 2;  // vectors of eight channels a
layout(constant_id = 1) const uint B = 4;  // channels b
layout(constant_id = 2) const uint NX = 8; // pixels per turn, a multiple of four
layout(constant_id = 3) const uint KH = 3; // kernel, stride, padding
layout(constant_id = 4) const uint KW = 3;
layout(constant_id = 5) const uint SH = 1;
layout(constant_id = 6) const uint SW = 1;
layout(constant_id = 7) const uint PH = 1;
layout(constant_id = 8) const uint PW = 1;
layout(constant_id = 9) const uint FLAGS = 0;

layout(binding = 0, rgba32f) uniform readonly imageBuffer smallQuads;
layout(binding = 1, rgba32f) uniform readonly imageBuffer largeQuads;
layout(binding = 2, scalar) writeonly buffer Strips { float strips[]; }; // [strip][a,b,ky,kx]
layout(push_constant, scalar) uniform Push { ConvWeightPush push; };

const uint kLanes = 8;
const uint TAPS = KH * KW;
const uint TURN = NX / 4;                                   // quads of a turn
const uint LEFT = (PW + 3) / 4;                             // quads before the pixel that meets the turn's first
const uint SKIP = 4 * LEFT - PW;                            // floats before the first that a tap reads
const uint REACH = (NX - 1) * SW + KW;                      // floats of a row that the taps read
const uint QUADS = (SKIP + REACH + 3) / 4;                  // of a row
const uint LOADS = (B * KH * QUADS + kLanes - 1) / kLanes; // of a lane

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
    uint smallChannels = push.smallChannels, largeChannels = push.largeChannels;
    int smallOffset = int(push.small.offset / 4), largeOffset = int(push.large.offset / 4);

    // The quads this lane loads for all eight: quad q of row ky of channel b.
    int dealtY[LOADS], dealtX[LOADS], dealtAddress[LOADS];
    [[unroll]] for (uint j = 0; j < LOADS; ++j) {
        uint e = min(j * kLanes + lane, B * KH * QUADS - 1);
        uint b = e / (KH * QUADS);
        uint ky = e / QUADS % KH;
        dealtY[j] = int(ky) - int(PH);
        dealtX[j] = int(e % QUADS) - int(LEFT);
        dealtAddress[j] = largeOffset + int(min(firstB + b, largeChannels - 1)) * largePlane + dealtY[j] * largeWidth + dealtX[j];
    }
    int channelAddress[A];
    [[unroll]] for (uint a = 0; a < A; ++a)
        channelAddress[a] = smallOffset + int(min(firstA + a * kLanes + lane, smallChannels - 1)) * smallPlane;

    float sum[A][B][TAPS];
    [[unroll]] for (uint a = 0; a < A; ++a)
        [[unroll]] for (uint b = 0; b < B; ++b)
            [[unroll]] for (uint t = 0; t < TAPS; ++t)
                sum[a][b][t] = 0.0;

    // Rows are numbered through the batch; one flat loop over their pieces of NX pixels.
    int perRow = (smallWidth + int(TURN) - 1) / int(TURN);
    int rows = int(push.pixels / push.small.width);
    int row = int(strip * push.stripLength);
    int turns = (min(row + int(push.stripLength), rows) - row) * perRow;
    int n = int(divide(uint(row), uint(smallHeight)));
    int y = row - n * smallHeight;
    int x = 0;
    int smallRow = n * smallImageStride + y * smallWidth;
    int largeRow = n * largeImageStride + y * int(SH) * largeWidth;
    for (int turn = 0; turn < turns; ++turn) {
        float left[A][NX];
        [[unroll]] for (uint a = 0; a < A; ++a)
            [[unroll]] for (uint q = 0; q < TURN; ++q) {
                bool inside = x + int(q) < smallWidth;
                vec4 quad = imageLoad(smallQuads, channelAddress[a] + smallRow + (inside ? x + int(q) : 0));
                [[unroll]] for (uint i = 0; i < 4; ++i)
                    left[a][4 * q + i] = inside ? quad[i] : 0.0;
            }
        vec4 dealt[LOADS];
        if ((FLAGS & kConvShuffle) != 0)
            [[unroll]] for (uint j = 0; j < LOADS; ++j) {
                bool inside = uint(y * int(SH) + dealtY[j]) < uint(largeHeight) && uint(x * int(SW) + dealtX[j]) < uint(largeWidth);
                vec4 quad = imageLoad(largeQuads, inside ? dealtAddress[j] + largeRow + x * int(SW) : largeOffset);
                dealt[j] = inside ? quad : vec4(0.0); // a select, not a product: NaN must not leak in
            }
        [[unroll]] for (uint b = 0; b < B; ++b)
            [[unroll]] for (uint ky = 0; ky < KH; ++ky)
                [[unroll]] for (uint i = 0; i < REACH; ++i) {
                    float right;
                    if ((FLAGS & kConvShuffle) != 0) {
                        uint e = (b * KH + ky) * QUADS + (SKIP + i) / 4;
                        right = subgroupShuffle(dealt[e / kLanes][(SKIP + i) % 4], e % kLanes);
                    } else {
                        int iy = y * int(SH) + int(ky) - int(PH);
                        int ix = x * int(SW) + int((SKIP + i) / 4) - int(LEFT);
                        bool inside = uint(iy) < uint(largeHeight) && uint(ix) < uint(largeWidth);
                        int at = largeOffset + n * largeImageStride +
                                 int(min(firstB + b, largeChannels - 1)) * largePlane + iy * largeWidth + ix;
                        vec4 quad = imageLoad(largeQuads, inside ? at : largeOffset);
                        right = inside ? quad[(SKIP + i) % 4] : 0.0;
                    }
                    [[unroll]] for (uint kx = 0; kx < KW; ++kx)
                        if (i >= kx && (i - kx) % SW == 0 && (i - kx) / SW < NX)
                            [[unroll]] for (uint a = 0; a < A; ++a)
                                sum[a][b][ky * KW + kx] += left[a][(i - kx) / SW] * right;
                }
        // The next piece, by counting: integer division has no vector form on a CPU.
        x += int(TURN);
        bool newRow = x >= smallWidth;
        x = newRow ? 0 : x;
        y += newRow ? 1 : 0;
        smallRow += newRow ? smallWidth : 0;
        largeRow += newRow ? int(SH) * largeWidth : 0;
        bool newImage = y == smallHeight;
        y = newImage ? 0 : y;
        n += newImage ? 1 : 0;
        smallRow = newImage ? n * smallImageStride : smallRow;
        largeRow = newImage ? n * largeImageStride : largeRow;
    }

    uint columns = largeChannels * TAPS;
    uint stripOffset = strip * push.stripStride;
    [[unroll]] for (uint a = 0; a < A; ++a) {
        uint channel = firstA + a * kLanes + lane;
        [[unroll]] for (uint b = 0; b < B; ++b)
            [[unroll]] for (uint t = 0; t < TAPS; ++t)
                if (channel < smallChannels && firstB + b < largeChannels)
                    strips[stripOffset + channel * columns + (firstB + b) * TAPS + t] = sum[a][b][t];
    }
}
