// Push constants and constants of the benchmark kernels (shaders/bench) and their callers.
#ifndef STRANDLIGHT_SHARED_BENCH_TYPES_H
#define STRANDLIGHT_SHARED_BENCH_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Independent chains hide the latency of an addition after a multiplication; chains, factor and addend fill the
// sixteen vector registers of lavapipe's code (with 16 chains it spills and is 2.5 times slower). Steps are unrolled:
// every turn of a loop blends what it carries with the lane mask.
STRANDLIGHT_CONST(uint) kBenchChains = 14u;
STRANDLIGHT_CONST(uint) kBenchUnroll = 16u;
STRANDLIGHT_CONST(uint) kBenchExpChains = 16u; // by eights
STRANDLIGHT_CONST(uint) kBenchExpUnroll = 4u;

struct BenchLoopPush
{
    uint turns;
    float factor;
    float addend;
};

struct BenchTriadPush
{
    float factor;
};

// A convolution of stride 1 over one image [I,H,W], square kernel.
struct BenchConvPush
{
    uint inChannels;
    uint outChannels;
    uint height;
    uint width;
    uint kernel;
    uint padding;
};

STRANDLIGHT_SHARED_END

#endif
