// Push constants and constants of the benchmark kernels (shaders/bench) and their callers.
#ifndef STRANDLIGHT_SHARED_BENCH_TYPES_H
#define STRANDLIGHT_SHARED_BENCH_TYPES_H

#ifdef __cplusplus
#include "shaders/shared/gpu_types.h"
#else
#include "shared/gpu_types.h"
#endif

STRANDLIGHT_SHARED_BEGIN

// Independent chains hide the latency of an addition after a multiplication; steps are unrolled so that
// the loop itself costs nothing.
STRANDLIGHT_CONST(uint) kBenchChains = 16u;
STRANDLIGHT_CONST(uint) kBenchUnroll = 16u;
STRANDLIGHT_CONST(uint) kBenchTriadTile = 16u; // elements of one invocation

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

STRANDLIGHT_SHARED_END

#endif
