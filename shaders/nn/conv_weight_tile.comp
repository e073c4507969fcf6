// Weight gradient of a convolution on a GPU, first stage: each workgroup sums one strip of
//   strip[s][a,b,ky,kx] = sum over the strip of small[n,a,y,x] large[n,b, y SH - PH + ky, x SW - PW + kx]
// Convolution: small = dY, large = x, a = output, b = input channel. Transposed: small = x, large = dY, a = input, b = output.
//
// The product of two matrices, tiled: A channels a by TB rows (b,ky), over PX pixels of a row at a time. Both tiles lie in
// shared memory, padded against bank conflicts; a thread keeps KA channels x KW taps of one row (b,ky) in registers.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "shared/nn_types.h"
#include "nn/divide.glsl"

layout(local_size_x = kWeightTileThreads) in;
layout(constant_id = 0) const uint TA = 4;  // threads across the channels a
layout(constant_id = 1) const uint PX = 32; // pixels of a step, a multiple of four
layout(constant_id = 2) const uint KH = 3;  // kernel, stride, padding
layout(constant_id = 3) const uint KW = 3;
layout(constant_id = 4) const uint SH = 1;
layout(constant_id = 5) const uint SW = 1;
layout(constant_id = 6) const uint PH = 1;
layout(constant_id = 7) const uint PW = 1;

layout(binding = 0, r32f) uniform readonly imageBuffer smallTensor;
layout(binding = 1, r32f) uniform readonly imageBuffer largeTensor;
layout(binding = 2, scalar) writeonly buffer Strips { float strips[]; }; // [strip][a,b,ky,kx]
layout(push_constant, scalar) uniform Push { ConvWeightPush push; };

const uint KA = kWeightTileChannels;
const uint A = TA * KA;
const uint TB = kWeightTileThreads / TA;
const uint QUADS = PX / 4;
const uint REACH = 3 * SW + KW;          // floats of a row that the taps of four pixels read
const uint SPAN = (PX - 1) * SW + KW;    // of PX pixels
const uint PITCH = SPAN + 1 - SPAN % 2;  // odd: neighbouring rows start in different banks
shared vec4 smallTile[QUADS * (A + 1)];  // [pixel / 4][a], four pixels each
shared float largeTile[TB * PITCH];      // [(b,ky)][x]

void main()
{
    uint thread = gl_LocalInvocationID.x;
    uint strip = push.firstStrip + gl_WorkGroupID.z;
    uint firstRow = gl_WorkGroupID.x * TB; // rows (b,ky)
    uint firstA = gl_WorkGroupID.y * A;
    uint ta = thread % TA, tb = thread / TA;
    uint rows = push.largeChannels * KH;
    uint smallPlane = push.small.height * push.small.width, largePlane = push.large.height * push.large.width;

    float sum[KA][KW];
    [[unroll]] for (uint k = 0; k < KA; ++k)
        [[unroll]] for (uint kx = 0; kx < KW; ++kx)
            sum[k][kx] = 0.0;

    // Steps: pieces of PX pixels, numbered through rows and images.
    uint perRow = (push.small.width + PX - 1) / PX;
    uint step = strip * push.stripLength;
    uint end = min(step + push.stripLength, push.pixels / push.small.width * perRow);
    for (; step < end; ++step) {
        uint row = divide(step, perRow);
        uint n = divide(row, push.small.height);
        uint y = row - n * push.small.height;
        uint x0 = (step - row * perRow) * PX;
        for (uint e = thread; e < A * PX; e += kWeightTileThreads) {
            uint a = e / PX, x = e % PX;
            bool inside = firstA + a < push.smallChannels && x0 + x < push.small.width;
            uint at = push.small.offset + n * push.small.imageStride + (firstA + a) * smallPlane + y * push.small.width + x0 + x;
            float loaded = imageLoad(smallTensor, int(inside ? at : push.small.offset)).x;
            smallTile[x / 4 * (A + 1) + a][x % 4] = inside ? loaded : 0.0;
        }
        for (uint e = thread; e < TB * SPAN; e += kWeightTileThreads) {
            uint r = e / SPAN, x = e % SPAN;
            uint b = (firstRow + r) / KH, ky = (firstRow + r) % KH;
            uint iy = y * SH + ky - PH, ix = x0 * SW + x - PW; // wrap below zero: refused
            bool inside = firstRow + r < rows && iy < push.large.height && ix < push.large.width;
            uint at = push.large.offset + n * push.large.imageStride + b * largePlane + iy * push.large.width + ix;
            float loaded = imageLoad(largeTensor, int(inside ? at : push.large.offset)).x;
            largeTile[r * PITCH + x] = inside ? loaded : 0.0;
        }
        barrier();
        for (uint q = 0; q < QUADS; ++q) {
            float right[REACH];
            [[unroll]] for (uint i = 0; i < REACH; ++i)
                right[i] = largeTile[tb * PITCH + 4 * q * SW + i];
            [[unroll]] for (uint k = 0; k < KA; ++k) {
                vec4 left = smallTile[q * (A + 1) + k * TA + ta];
                [[unroll]] for (uint i = 0; i < 4; ++i)
                    [[unroll]] for (uint kx = 0; kx < KW; ++kx)
                        sum[k][kx] += left[i] * right[i * SW + kx];
            }
        }
        barrier();
    }

    uint r = firstRow + tb;
    [[unroll]] for (uint k = 0; k < KA; ++k) {
        uint a = firstA + k * TA + ta;
        [[unroll]] for (uint kx = 0; kx < KW; ++kx)
            if (a < push.smallChannels && r < rows)
                strips[strip * push.stripStride + (a * rows + r) * KW + kx] = sum[k][kx];
    }
}
