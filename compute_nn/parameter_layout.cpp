#include "compute_nn/parameter_layout.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/error.hpp"
#include "shaders/shared/rng.h"

namespace strandlight {

std::uint32_t ParameterLayout::add(std::string name, std::vector<std::uint64_t> shape,
                                   std::uint32_t fanIn)
{
    ParameterSlice slice{std::move(name), std::move(shape), count_, 1, fanIn};
    for (std::uint64_t side : slice.shape)
        slice.count *= std::uint32_t(side);
    count_ += slice.count;
    slices_.push_back(std::move(slice));
    return std::uint32_t(slices_.size() - 1);
}

void ParameterLayout::addLayer(const std::string& name, std::vector<std::uint64_t> weightShape,
                               std::uint32_t biasCount, std::uint32_t fanIn)
{
    add(name + ".weight", std::move(weightShape), fanIn);
    add(name + ".bias", {biasCount}, 0);
}

const ParameterSlice& ParameterLayout::slice(const std::string& name) const
{
    for (const ParameterSlice& slice : slices_)
        if (slice.name == name)
            return slice;
    throw Error("the network has no parameter \"" + name + "\"");
}

std::vector<float> ParameterLayout::initialValues(std::uint32_t seed) const
{
    std::vector<float> values(count_, 0.0f);
    for (std::uint32_t index = 0; index < slices_.size(); ++index) {
        const ParameterSlice& slice = slices_[index];
        if (slice.fanIn == 0)
            continue;
        const double deviation = std::sqrt(2.0 / slice.fanIn);
        for (std::uint32_t i = 0; i < slice.count; ++i) {
            // Box and Muller; 1 - u is never 0. Double, then rounded once, so every platform
            // agrees.
            const glm::vec3 u = gpu::uniform3(i, index, 0, seed);
            const double radius = std::sqrt(-2.0 * std::log(1.0 - double(u.x)));
            values[slice.offset + i] =
                float(deviation * radius * std::cos(2.0 * std::numbers::pi * double(u.y)));
        }
    }
    return values;
}

} // namespace strandlight
