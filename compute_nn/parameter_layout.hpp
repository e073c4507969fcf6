// Where the weights of a network live: one block of floats, named slices in the order they were
// added.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace strandlight {

struct ParameterSlice
{
    std::string name;
    std::vector<std::uint64_t> shape;
    std::uint32_t offset = 0; // floats from the start of the block
    std::uint32_t count = 0;
    std::uint32_t fanIn = 0; // inputs that one output sums; 0: starts at zero (a bias)
};

class ParameterLayout
{
public:
    // Weights start at He's normal distribution of `fanIn`, biases (fanIn 0) at zero. Returns the
    // slice's index.
    std::uint32_t add(std::string name, std::vector<std::uint64_t> shape, std::uint32_t fanIn);
    // "<name>.weight" [O,I,Kh,Kw] and "<name>.bias" [bias], next to each other.
    void addLayer(const std::string& name, std::vector<std::uint64_t> weightShape,
                  std::uint32_t biasCount, std::uint32_t fanIn);

    const ParameterSlice& slice(const std::string& name) const; // throws Error: no such parameter
    const std::vector<ParameterSlice>& slices() const { return slices_; }
    std::uint32_t count() const { return count_; } // floats in the block

    // He, Zhang, Ren, Sun. Delving Deep into Rectifiers. 2015. A pure function of (layout, seed).
    std::vector<float> initialValues(std::uint32_t seed) const;

private:
    std::vector<ParameterSlice> slices_;
    std::uint32_t count_ = 0;
};

} // namespace strandlight
