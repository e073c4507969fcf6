// What ties a bake to its scene, and a checkpoint to its bake.
#pragma once

#include <cstdint>

#include "engine/scene/scene.hpp"
#include "passes/bake.hpp"

namespace strandlight {

// Of triangle positions, in order.
std::uint64_t hashGeometry(const Scene& scene);
// Of the environment's pixels; 0 without one.
std::uint64_t hashEnvironment(const Scene& scene);
// Of everything that decides what light is where: geometry, environment, materials, lights.
std::uint64_t hashScene(const Scene& scene);
// Of everything that decides what a bake computes: scene, environment, materials, lights, settings.
std::uint64_t hashBake(const Scene& scene, const BakeSettings& settings);

} // namespace strandlight
