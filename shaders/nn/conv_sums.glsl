// Sums of a convolution along rows: SUM_BLOCKS blocks, of a channel and a row of the result, of NX columns each. Behind
// conv_rows.glsl and the `window` of input pixels that an invocation loads of one channel; the kernel defines SUM_BLOCKS.
//
// Under kConvMinimal the sums are those of minimal_filter.h at the points of each four columns.
#ifndef STRANDLIGHT_NN_CONV_SUMS_GLSL
#define STRANDLIGHT_NN_CONV_SUMS_GLSL

const uint COLUMN_TILES = MINIMAL ? NX / kMinimalTile : 1;
const uint SUMS = MINIMAL ? COLUMN_TILES * kMinimalPoints : NX;

float sum[SUM_BLOCKS][SUMS];

void clearSums()
{
    [[unroll]] for (uint i = 0; i < SUM_BLOCKS; ++i)
        [[unroll]] for (uint n = 0; n < SUMS; ++n)
            sum[i][n] = 0.0;
}

// Of a row of the window and four columns of the result.
MinimalPoints pointsOfWindow(uint row, uint tile)
{
    float inputs[6];
    [[unroll]] for (uint j = 0; j < 6; ++j)
        inputs[j] = window[row][tile * kMinimalTile + j];
    return minimalInputs(inputs);
}

// Sums of four columns from n on.
vec4 sumsOfFour(uint block, uint n)
{
    if (!MINIMAL)
        return vec4(sum[block][n], sum[block][n + 1], sum[block][n + 2], sum[block][n + 3]);
    MinimalPoints m;
    [[unroll]] for (uint j = 0; j < kMinimalPoints; ++j)
        m.at[j] = sum[block][n / kMinimalTile * kMinimalPoints + j];
    return minimalResults(m);
}

void storeBlock(uint block, Target target, uint channel, uint y, uint x, float bias)
{
#ifdef RESULT_WIDE
    [[unroll]] for (uint n = 0; n < NX; n += 8)
        storeOctet(target, channel, y, x + n, sumsOfFour(block, n) + bias, sumsOfFour(block, n + 4) + bias);
#else
    [[unroll]] for (uint n = 0; n < NX; n += 4) {
        vec4 four = sumsOfFour(block, n) + bias;
        if ((FLAGS & kConvQuads) != 0)
            storeQuad(target, channel, y, x + n, four);
        else
            [[unroll]] for (uint c = 0; c < 4; ++c)
                storeFloat(target, channel, y, x + n + c, four[c]);
    }
#endif
}

#endif
