// The cases of `strandlight bench kernels`: each is checked against its CPU twin, then timed.
#pragma once

#include <functional>
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
    double flops = 0.0;         // a multiply and an add are two; 0: not counted
    double bytes = 0.0;         // read and written once each; 0: not counted
    Json more = Json::object(); // further columns of the row
};

// What this device reaches where nothing else is in the way: fractions are of these.
struct Ceilings
{
    KernelMeasurement multiplyAdd; // chains in registers, unfused where the device does not fuse
    KernelMeasurement exponential; // flops: exponentials
    KernelMeasurement triad;       // a = b + s c over buffers larger than the caches

    double gflops() const { return multiplyAdd.flops / multiplyAdd.timing.minimum * 1e-6; }
    double gigabytes() const { return triad.bytes / triad.timing.minimum * 1e-6; } // per second
    // Flops that the device does in the time of one exponential.
    double flopsOfExp() const
    {
        return gflops() / (exponential.flops / exponential.timing.minimum * 1e-6);
    }
};
Ceilings measureCeilings(Context& context, const BenchOptions& options);

struct KernelCase
{
    std::string name;
    std::function<KernelMeasurement(Context&, const BenchOptions&, const Ceilings&)> measure;
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
