// Push constants and constants that the network kernels and their callers share.
#ifndef STRANDLIGHT_SHARED_NN_TYPES_H
#define STRANDLIGHT_SHARED_NN_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Decoder of a spherical-gaussian lobe, 7 raw values: axis (3), sharpness, amplitude (3).
STRANDLIGHT_CONST(float) kSgSharpnessOffset = 2.0f;  // raw 0 is a sharpness of e^2, a lobe of about 40 degrees
STRANDLIGHT_CONST(float) kSgMinimumExponent = -15.0f;
STRANDLIGHT_CONST(float) kSgMaximumExponent = 11.5f; // sharpness 1e5: beyond it fp32 chords lose their digits
STRANDLIGHT_CONST(float) kSgTinyAxis = 1e-30f;       // an axis shorter than this has no direction

STRANDLIGHT_CONST(float) kRelativeLossFloor = 0.01f; // (radiance)^2

// What a convolution kernel adds to its sum; bits of its FLAGS.
STRANDLIGHT_CONST(uint) kConvBias = 1u;       // + bias[o]
STRANDLIGHT_CONST(uint) kConvAccumulate = 2u; // + what the output holds already
STRANDLIGHT_CONST(uint) kConvDerivative = 4u; // x (saved > 0 ? 1 : slope): back through a leaky relu
STRANDLIGHT_CONST(uint) kConvShuffle = 8u;    // weights or pixels by subgroup shuffle; needs 8 lanes or more

STRANDLIGHT_CONST(uint) kConvTiles = 16u;     // over a list of active tiles of one image
STRANDLIGHT_CONST(uint) kConvQuads = 32u;     // rows are whole texels of four floats
STRANDLIGHT_CONST(uint) kConvContinue = 64u;  // sums begin with what the output holds; of kernels that fetch their input
STRANDLIGHT_CONST(uint) kConvMinimal = 128u;  // three taps a row, stride 1, by minimal_filter.h
STRANDLIGHT_CONST(uint) kConvWhole = 256u;    // of conv_weight_points.comp: whole turns, and tensors of the same size

// Side of a TileList's square tiles, in pixels of the layer's output: a multiple of the register tiles of the row kernels.
STRANDLIGHT_CONST(uint) kTileSide = 8u;
// Indirect arguments of a TileList, (workgroups, b, 1): 2^s tiles a workgroup, s below kTileShares, and b = 1, 2, ...
// blocks of output channels.
STRANDLIGHT_CONST(uint) kTileShares = 5u;
STRANDLIGHT_CONST(uint) kTileBlocks = 16u;

// Where a planar tensor, or a range of its channels, lies in a buffer of floats.
struct TensorView
{
    uint offset;      // first float
    uint imageStride; // floats from image to image
    uint height;
    uint width;
};

struct ConvPush
{
    TensorView source;
    TensorView result;
    uint savedOffset; // kConvDerivative: a tensor of the result's height and width
    uint savedImageStride;
    uint inChannels;
    uint outChannels;
    uint weightOffset;
    uint weightStrideOut; // floats between the weights of neighbouring output channels
    uint weightStrideIn;
    uint biasOffset;
    uint kernelHeight;
    uint kernelWidth;
    uint strideHeight;
    uint strideWidth;
    uint paddingHeight;
    uint paddingWidth;
    uint transposed;
    uint firstPixel; // this dispatch works on pixels [firstPixel, endPixel) of the [N,H,W] grid of one phase
    uint endPixel;
    float slope; // of the activation below zero; 1: no activation
};

// conv_rows.comp, conv_transpose_rows.comp, hair_conv.comp and the kernels of conv_lanes.glsl; kernel, stride and padding are specialisation constants.
struct ConvRowsPush
{
    TensorView source;
    TensorView result;
    uint savedOffset;
    uint savedImageStride;
    uint inChannels;
    uint outChannels;
    uint biasOffset;
    uint firstGroup; // of this dispatch: block of channels x row phases + phase
    uint firstStrip; // this dispatch works on strips [firstStrip, endStrip); of conv_lanes.glsl the first row of tiles
    uint endStrip;
    float slope;
};

// Weights for those, by conv_pack.comp.
struct ConvPackPush
{
    uint texels; // in all
    uint weightOffset;
    uint weightStrideOut; // floats between the weights of neighbouring output channels
    uint weightStrideIn;
    uint outChannels;
    uint laneChannels; // channels of a block are dealt to so many lanes, each having its own texels
    uint channelLanes; // (1: a block has no lanes)
    uint turns;      // loop turns
    uint turnInputs; // input channels of a turn
    uint turnTexels;
    uint taps; // of a row phase, of which there are
    uint phases;
    uint rowTaps; // of a kernel row
    uint kernelHeight;
    uint kernelWidth;
    uint paddingHeight;
    uint minimal;      // rowTaps are points
    uint turned;       // the kernel is turned about
};

// conv_weight_tile.comp: threads of a workgroup, and channels a of a thread.
STRANDLIGHT_CONST(uint) kWeightTileThreads = 128u;
STRANDLIGHT_CONST(uint) kWeightTileChannels = 8u;

// dWeight[a,b,ky,kx] = sum over n,y,x of small[n,a,y,x] large[n,b, y stride - padding + ky, x stride - padding + kx]
struct ConvWeightPush
{
    TensorView small;
    TensorView large;
    uint smallChannels;
    uint largeChannels;
    uint kernelHeight;
    uint kernelWidth;
    uint strideHeight;
    uint strideWidth;
    uint paddingHeight;
    uint paddingWidth;
    uint pixels;      // N H W of the small tensor
    uint stripLength; // what one invocation or workgroup sums, in units of its kernel
    uint firstStrip;  // of this dispatch
    uint stripStride; // floats from strip to strip
    uint strideSmall; // of conv_weight_points.comp: floats from channel to channel
    uint strideLarge;
    uint turned;      // of the same: the last tap comes first
};

struct ChannelSumPush
{
    TensorView tensor;
    uint images;
    uint invocations; // of a channel: strips
    uint stripStride;
};

struct ReducePush
{
    uint count;       // floats of a strip that count,
    uint stride;      // and that it takes: whole quads
    uint strips;
    uint groupStrips; // summed by one invocation
    uint resultOffset;
    uint accumulate; // add to the result
};

struct ElementPush
{
    TensorView source;
    TensorView result;
    TensorView saved;
    uint channelPixels; // C H W
    float slope;
};

// A kernel of 3x3 taps for each pixel of four planes.
STRANDLIGHT_CONST(uint) kFilterTaps = 9u;
STRANDLIGHT_CONST(uint) kFilterChannels = 4u;

// Planes of a binding of the logits: three bindings hold a larger image than one.
STRANDLIGHT_CONST(uint) kFilterGroup = 3u;

struct KernelFilterPush
{
    TensorView image;
    uint logitOffset[3]; // of each group
    uint logitImageStride;
    uint dYOffset; // backward
    uint dYImageStride;
    uint resultOffset[3]; // y has the first alone
    uint resultImageStride;
};

// tile_list.comp: TileReach, TouchedBlocks and TileRows of compute_nn/unet_tiles.hpp.
struct TileListPush
{
    uint tilesAcross;
    uint tilesDown;
    uint level;
    uint before;
    uint after;
    uint blocksAcross;
    uint blocksDown;
    uint tensorRow;
    uint firstRow;
    uint endRow;
};

struct SumPush
{
    uint count;       // floats
    uint turns;       // of one invocation, four floats each
    uint invocations; // one, or a multiple of eight
    float scale;      // of the result
};

struct LossPush
{
    uint count;        // of this dispatch
    uint chunk;        // elements of one invocation
    uint firstChunk;   // of this dispatch, among all
    uint weightStride; // element i of all has weight[i / weightStride % weightCount]
    uint weightCount;
    float scale;       // 1 / count
};

struct FiniteCheckPush
{
    uint firstTexel;
    uint texels;
    uint invocations; // whole workgroups: they take texels in turn
    uint slot;
    float limit; // larger magnitudes are refused like infinities
};

struct AdamPush
{
    uint count;
    float stepSize;
    float inverseRootCorrection2;
    float beta1;
    float beta2;
    float oneMinusBeta1; // rounded from double: 1 - 0.999f loses four digits
    float oneMinusBeta2;
    float epsilon;
};

// Directions that one invocation of the forward mixture works through.
STRANDLIGHT_CONST(uint) kSgMixtureSlice = 256u;

// Element (n, direction, c) of a radiance tensor is at n 3 D + direction directionStride + c channelStride.
struct SgMixturePush
{
    uint images;
    uint lobes;
    uint directions;           // D
    uint directionImageStride; // floats between the direction lists of two images; 0: all share one
    uint directionStride;
    uint channelStride;
    uint firstImage; // of this dispatch
};

// Slots of the per-step status; each counts refused values of one tensor.
STRANDLIGHT_CONST(uint) kStatusSlots = 8u;
// Counters that live as long as the parameters: steps taken, steps skipped, then the sum of every slot.
STRANDLIGHT_CONST(uint) kCounterTaken = 0u;
STRANDLIGHT_CONST(uint) kCounterSkipped = 1u;
STRANDLIGHT_CONST(uint) kCounterSlots = 2u;

STRANDLIGHT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(strandlight::gpu::ConvPush) == 104);
static_assert(sizeof(strandlight::gpu::ConvRowsPush) == 68);
static_assert(sizeof(strandlight::gpu::ConvWeightPush) == 92);
#endif

#endif
