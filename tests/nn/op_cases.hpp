// One table of operations: what the device computes and what the CPU twin computes from the same
// numbers. A new operation enters the table and is at once checked for value, gradient and
// repeatability (test_ops.cpp).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/vk/context.hpp"

namespace strandlight::test {

struct Output
{
    std::string name;
    std::vector<float> values;
};
struct ExpectedOutput
{
    std::string name;
    std::vector<double> values;
};

struct OpCase
{
    std::string name;
    std::function<std::vector<Output>(Context&)> device;
    std::function<std::vector<ExpectedOutput>()> twin; // the same outputs in the same order
};

// Checks values [n] against the twin's, in the norm and element by element; gives the error in the
// norm.
double checkOutput(const Output& got, const ExpectedOutput& wanted);

// Cases by file: op_cases_conv.cpp, op_cases_other.cpp.
void addConvCases(std::vector<OpCase>& cases);
void addSubgroupCases(std::vector<OpCase>& cases);
// Shapes for the kernels that a GPU takes.
void addGpuFormCases(std::vector<OpCase>& cases); // a few of them, one of each kernel
void addOtherCases(std::vector<OpCase>& cases);

} // namespace strandlight::test
