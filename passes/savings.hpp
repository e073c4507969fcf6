// What a bake did without, in totals: for `bake`, `render --stats` and the benchmarks.
#pragma once

#include <cstdint>

#include "engine/scene/scene.hpp"
#include "passes/sg_field.hpp"

namespace strandlight {

// Of both lobe sets together.
struct BakeSavings
{
    std::uint64_t places = 0; // of the atlas
    std::uint64_t texels = 0; // that have surface: the others are neither captured nor stored
    std::uint64_t lobes = 0;  // if every texel kept all
    std::uint64_t keptLobes = 0;
    std::uint64_t tiles = 0;     // of texels that keep the same lobes; 0: nothing was to be dropped
    std::uint64_t darkTiles = 0; // that keep none
};
BakeSavings bakeSavings(const SgBake& bake);

// The same bake with nothing dropped: what was is black. Shows what dropping saves.
SgBake withAllLobes(SgBake bake);

// False when no radiance can arrive anywhere: no environment, no light and no surface in use that
// emits.
bool sendsLight(const Scene& scene);

} // namespace strandlight
