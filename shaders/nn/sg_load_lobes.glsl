// The 7 x LOBES values of an image's lobes, in their order; of a kernel with the bindings `lobes` and `lobeQuads` (the same
// memory, as single floats and as texels of four). Four lobes are seven texels, which a CPU device loads in a fifth of the
// time of 28 floats.
#ifndef STRANDLIGHT_NN_SG_LOAD_LOBES_GLSL
#define STRANDLIGHT_NN_SG_LOAD_LOBES_GLSL

float lobeValues[7 * LOBES + 3];

// `first`: lobe, a multiple of LOBES.
void loadLobeValues(uint first)
{
    int at = int(first) * 7;
    if (LOBES % 4 == 0) {
        [[unroll]] for (uint i = 0; i < 7 * LOBES; i += 4) {
            vec4 quad = imageLoad(lobeQuads, (at + int(i)) / 4);
            [[unroll]] for (uint j = 0; j < 4; ++j)
                lobeValues[i + j] = quad[j];
        }
    } else {
        [[unroll]] for (uint i = 0; i < 7 * LOBES; ++i)
            lobeValues[i] = imageLoad(lobes, at + int(i)).x;
    }
}

#endif
