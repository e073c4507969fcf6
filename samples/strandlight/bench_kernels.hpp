// The cases of `strandlight bench kernels`: each is checked against its CPU twin, then timed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

// What one case found. `error` is relative to the norm of the sampled outputs of the twin (double).
struct KernelMeasurement
{
    double error = 0.0;
    double tolerance = 5e-6; // fp32 sums of a thousand products against double: measured below 1e-6
    Timing timing;
    double flops = 0.0; // a multiply and an add are two; 0: not counted
    double bytes = 0.0; // read and written once each; 0: not counted
    // Shares of what a ceiling did that ran in turns with the case; 0: not compared.
    double ofMultiplyAdd = 0.0;
    double ofTriad = 0.0;
    Json more = Json::object(); // further columns of the row
};

// A kernel that does one thing only; its graph stays, to run in turns with others.
struct Ceiling
{
    std::vector<std::unique_ptr<Buffer>> buffers; // that the graph borrows
    std::unique_ptr<RenderGraph> graph;
    KernelMeasurement found;
};

// What this device reaches where nothing else is in the way: fractions are of these.
struct Ceilings
{
    Ceiling multiplyAdd;     // chains in registers, unfused where the device does not fuse
    Ceiling exponential;     // flops: exponentials
    Ceiling triad;           // a = b + s c over buffers larger than the caches
    double flopsOfExp = 0.0; // that the device does in the time of one exponential

    double gflops() const // best run
    {
        return multiplyAdd.found.flops / multiplyAdd.found.timing.minimum * 1e-6;
    }
    double gigabytes() const { return triad.found.bytes / triad.found.timing.minimum * 1e-6; }
};
Ceilings measureCeilings(Context& context, const BenchOptions& options);

std::uint32_t roundsOf(const BenchOptions& options);

// Times `graph` in turns with `others` and a ceiling: multiply-add where `m` counts flops, else the
// triad. Fills timing and share of `m`; in the result the graph is 0, others follow.
RoundTimings timeBeside(KernelMeasurement& m, Ceilings& ceilings, RenderGraph& graph,
                        std::vector<RenderGraph*> others, std::uint32_t rounds);

struct KernelCase
{
    std::string name;
    std::function<KernelMeasurement(Context&, const BenchOptions&, Ceilings&)> measure;
};

// By subject, one source file each.
void addConvBenchCases(std::vector<KernelCase>& cases);
void addNetworkBenchCases(std::vector<KernelCase>& cases,
                          bool halves); // halves: the device has them
void addSgBenchCases(std::vector<KernelCase>& cases);
void addReductionBenchCases(std::vector<KernelCase>& cases);
void addFirstRunBenchCases(std::vector<KernelCase>& cases);

// What the training steps of the network cases will allocate: plans, nothing is run.
void printMemoryPlans(Context& context);

// Throws Error, naming the case, when the check of `measurement` has not passed.
void requireCheck(const std::string& name, const KernelMeasurement& measurement);

// Uniform in [-1, 1), a pure function of (seed, i).
std::vector<float> randomValues(std::size_t count, std::uint32_t seed);

// |got - wanted| / |wanted| in the Euclidean norm; NaN anywhere gives NaN.
double normError(const std::vector<double>& got, const std::vector<double>& wanted);

} // namespace strandlight::cli
