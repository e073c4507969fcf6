// What a hair picture took: passes, strands, tiles of the filter network.
#pragma once

#include "engine/vk/context.hpp"
#include "passes/hair_render.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

double totalMilliseconds(const HairFrame& frame);

// Share of the network's multiply-adds that tiles without hair saved; 0 without a network.
double savedWork(const HairFrame& frame);

void printHairStats(const Context& context, const HairStrands& hair, const HairFrame& frame);
Json describeTiles(const HairFrame& frame);

} // namespace strandlight::cli
