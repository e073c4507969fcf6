// The register tile of a convolution along rows: K output channels x NX columns of sums. Behind conv_rows.glsl and the
// `window` of input pixels that a strip reads of one channel.
#ifndef STRANDLIGHT_NN_CONV_SUMS_GLSL
#define STRANDLIGHT_NN_CONV_SUMS_GLSL

float sum[K][NX];

void clearSums()
{
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint n = 0; n < NX; ++n)
            sum[k][n] = 0.0;
}

// The window of input channel `u` of a turn, whose weights are dealt and begin at `weights`.
void addWindow(int weights, uint u)
{
    [[unroll]] for (uint k = 0; k < K; ++k)
        [[unroll]] for (uint t = 0; t < TAPS; ++t) {
            float weight = dealtWeight(weights, (u * K + k) * TAPS + t);
            [[unroll]] for (uint n = 0; n < NX; ++n)
                sum[k][n] += weight * window[t / KW][n * SW + t % KW];
        }
}

void storeSums(Strip strip, Target target)
{
    uint firstChannel = groupOfInvocation() * K;
    [[unroll]] for (uint k = 0; k < K; ++k) {
        float bias = biasOf(firstChannel + k);
#ifdef RESULT_WIDE
        [[unroll]] for (uint n = 0; n < NX; n += 8)
            storeOctet(target, firstChannel + k, strip.row, strip.column + n,
                       vec4(sum[k][n], sum[k][n + 1], sum[k][n + 2], sum[k][n + 3]) + bias,
                       vec4(sum[k][n + 4], sum[k][n + 5], sum[k][n + 6], sum[k][n + 7]) + bias);
#else
        if ((FLAGS & kConvQuads) != 0) {
            [[unroll]] for (uint n = 0; n < NX; n += 4)
                storeQuad(target, firstChannel + k, strip.row, strip.column + n,
                          vec4(sum[k][n], sum[k][n + 1], sum[k][n + 2], sum[k][n + 3]) + bias);
        } else {
            [[unroll]] for (uint n = 0; n < NX; ++n)
                storeFloat(target, firstChannel + k, strip.row, strip.column + n, sum[k][n] + bias);
        }
#endif
    }
    reportLargest();
}

#endif
