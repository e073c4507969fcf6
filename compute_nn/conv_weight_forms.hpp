// Which kernel sums a weight gradient, in which tiles and strips; internal to the convolution
// passes.
#pragma once

#include <cstdint>
#include <vector>

#include "compute_nn/conv_desc.hpp"
#include "compute_nn/tensor.hpp"
#include "engine/base/kernel_blob.hpp"

namespace strandlight {

// gradient[a,b,ky,kx] += sum small[n,a,y,x] large[n,b, y sh - ph + ky, x sw - pw + kx]
struct Correlation
{
    Extent2 kernel, stride, padding;
    TensorId small, large;
};

struct WeightForm
{
    const KernelBlob* blob = nullptr;
    std::vector<std::uint32_t> constants;
    std::uint32_t tilesA = 1, tilesB = 1; // workgroups of one strip
    std::uint32_t strips = 1;
    std::uint32_t stripLength = 1; // in units of the kernel
    std::uint32_t unitTurns = 1;   // at most, of the kernel's loop
    std::uint32_t groupSize = 8;   // threads of a workgroup
    std::uint64_t stripWork = 1;   // multiply-adds of a strip, dead ones too
    bool turned = false; // small and large change places, the last tap comes first (stride 1)
};

// `cpu` as Context::cpuForms(), `shuffleFlag` as conv_work.hpp has it.
WeightForm weightForm(bool cpu, std::uint32_t shuffleFlag, const Correlation& correlation);

} // namespace strandlight
