#include "compute_nn/half_guard.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"

namespace strandlight {

namespace {

constexpr std::size_t kMostLayers = 64;
constexpr std::size_t kSlot = Binding::kAlignment; // bytes

} // namespace

HalfGuard::HalfGuard(RenderGraph& graph)
    : largest_(graph.createBuffer("largest refused halves", kMostLayers * kSlot))
{
    const std::string& missing = graph.context().device().missingForHalves;
    if (!missing.empty())
        throw Error("precision fp16: the device lacks " + missing);
    PassBuilder pass = graph.addTransferPass("clear half guard");
    largest_ = pass.write(largest_);
    pass.fill(largest_, 0);
}

Binding HalfGuard::bind(PassBuilder& pass, std::string_view layer)
{
    // A layer of several passes has one slot.
    auto found = std::find(layers_.begin(), layers_.end(), layer);
    if (found == layers_.end())
        found = layers_.insert(layers_.end(), std::string(layer));
    STRANDLIGHT_ASSERT(layers_.size() <= kMostLayers);
    largest_ = pass.write(largest_);
    return {largest_, std::uint64_t(found - layers_.begin()) * kSlot, sizeof(std::uint32_t)};
}

void HalfGuard::output(RenderGraph& graph) const
{
    graph.output(largest_);
}

void HalfGuard::check(const RenderGraph& graph) const
{
    const std::vector<std::uint32_t> slots = graph.read<std::uint32_t>(largest_);
    for (std::size_t i = 0; i < layers_.size(); ++i)
        if (const std::uint32_t bits = slots[i * kSlot / sizeof(std::uint32_t)])
            throw Error("precision fp16: layer " + layers_[i] + " makes a value of " +
                        std::to_string(std::bit_cast<float>(bits)) +
                        ", a half ends at 65504; use fp32");
}

} // namespace strandlight
