// The window of input pixels that an invocation loads of one channel: WH rows, each ROW_STEP-th from `firstRow` on, and WW
// columns from LEFT before `column` on. For a kernel with these constants, behind conv_rows.glsl; `column` is a multiple of
// four under kConvQuads.
//
// Addresses are kept inside the image and what lies outside is replaced by zero: a select, not a product, for NaN must
// not leak in.
#ifndef STRANDLIGHT_NN_CONV_WINDOW_GLSL
#define STRANDLIGHT_NN_CONV_WINDOW_GLSL

layout(binding = 0, SOURCE_TEXEL) uniform readonly imageBuffer inputTensor; // [N,C,H,W]
layout(binding = 1, SOURCE_QUAD) uniform readonly imageBuffer inputQuads;

const uint SPAN = (FLAGS & kConvQuads) != 0 ? 4 : 1;     // columns of a load
const uint BEFORE = (LEFT + SPAN - 1) / SPAN;            // loads of a row before `column`
const uint SKIP = BEFORE * SPAN - LEFT;                  // columns loaded before the window's first
const uint ROW_LOADS = (SKIP + WW + SPAN - 1) / SPAN;

float window[WH][WW];
int loadAddress[WH][ROW_LOADS]; // of the first channel, in units of a load
bool loadInside[WH][ROW_LOADS];

void placeWindow(int firstRow, int column, uint image)
{
    int width = int(push.source.width), height = int(push.source.height);
    int origin = int(push.source.offset + image * push.source.imageStride);
    [[unroll]] for (uint i = 0; i < WH; ++i)
        [[unroll]] for (uint j = 0; j < ROW_LOADS; ++j) {
            int y = firstRow + int(i * ROW_STEP);
            int x = column + (int(j) - int(BEFORE)) * int(SPAN);
            loadInside[i][j] = uint(y) < uint(height) && uint(x) < uint(width);
            loadAddress[i][j] = (origin + (loadInside[i][j] ? y * width + x : 0)) / int(SPAN);
        }
}

// `plane`: of the channel, in units of a load.
void loadWindow(int plane)
{
    [[unroll]] for (uint i = 0; i < WH; ++i)
        [[unroll]] for (uint j = 0; j < ROW_LOADS; ++j) {
            vec4 loaded;
            if ((FLAGS & kConvQuads) != 0)
                loaded = imageLoad(inputQuads, plane + loadAddress[i][j]);
            else
                loaded.x = imageLoad(inputTensor, plane + loadAddress[i][j]).x;
            [[unroll]] for (uint c = 0; c < SPAN; ++c) {
                uint x = j * SPAN + c - SKIP; // beyond WW where it is left of the window
                if (x < WW)
                    window[i][x] = loadInside[i][j] ? loaded[c] : 0.0;
            }
        }
}

#endif
