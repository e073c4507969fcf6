// What a bake did without, on the terminal and for machines.
#pragma once

#include "passes/render_frame.hpp"
#include "passes/savings.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

// `lobeBytes`: of one lobe, where they are kept.
void printSavings(const BakeSavings& savings, std::uint64_t lobeBytes);
void printSharing(const FrameResult& frame); // of memory, between passes
Json describeSavings(const BakeSavings& savings, std::uint64_t lobeBytes);

} // namespace strandlight::cli
