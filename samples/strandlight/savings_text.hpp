// What a bake did without, on the terminal and for machines.
#pragma once

#include "passes/savings.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

// `lobeBytes`: of one lobe, where they are kept.
void printSavings(const BakeSavings& savings, std::uint64_t lobeBytes);
Json describeSavings(const BakeSavings& savings, std::uint64_t lobeBytes);

} // namespace strandlight::cli
