#include "compute_nn/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "kernels/nn.gen.hpp"

namespace strandlight {

Parameters::Parameters(Context& context, ParameterLayout layout, std::uint32_t seed)
    : layout_(std::move(layout)),
      values_(Buffer::from(context, layout_.initialValues(seed), "parameters")),
      gradient_(context, layout_.count() * 4, "gradient"),
      moment1_(context, layout_.count() * 4, "moment 1"),
      moment2_(context, layout_.count() * 4, "moment 2"),
      status_(context, gpu::kStatusSlots * 4, "step status"),
      counters_(context, (gpu::kCounterSlots + gpu::kStatusSlots) * 4, "optimiser counters")
{
}

void Parameters::upload(std::span<const float> values)
{
    STRANDLIGHT_ASSERT_EQ(values.size(), std::size_t(layout_.count()));
    values_.upload(std::as_bytes(values));
    const std::vector<float> zeros(layout_.count(), 0.0f);
    for (Buffer* moment : {&moment1_, &moment2_})
        moment->upload(std::as_bytes(std::span(zeros)));
}

OptimizerReport Parameters::report() const
{
    const std::vector<std::uint32_t> counters = counters_.downloadAs<std::uint32_t>();
    OptimizerReport report;
    report.stepsTaken = counters[gpu::kCounterTaken];
    report.stepsSkipped = counters[gpu::kCounterSkipped];
    for (std::uint32_t slot = 0; slot < slotNames_.size(); ++slot)
        if (const std::uint32_t count = counters[gpu::kCounterSlots + slot]) {
            report.refusedIn.push_back(slotNames_[slot]);
            report.refused.push_back(count);
        }
    return report;
}

void Parameters::save(Safetensors& file, bool withMoments) const
{
    const auto add = [&](const std::string& prefix, const std::vector<float>& block) {
        for (const ParameterSlice& slice : layout_.slices())
            file.tensors[prefix + slice.name] = {
                slice.shape,
                {block.begin() + slice.offset, block.begin() + slice.offset + slice.count}};
    };
    add("", download());
    if (!withMoments)
        return;
    add("adam.m.", moment1_.downloadAs<float>());
    add("adam.v.", moment2_.downloadAs<float>());
}

void Parameters::load(const Safetensors& file, const std::string& path)
{
    const auto gather = [&](const std::string& prefix) {
        std::vector<float> block(layout_.count());
        for (const ParameterSlice& slice : layout_.slices()) {
            const std::string place = "tensor \"" + prefix + slice.name + "\"";
            const auto found = file.tensors.find(prefix + slice.name);
            if (found == file.tensors.end())
                throw FileError(path, place, "is missing");
            if (found->second.shape != slice.shape)
                throw FileError(path, place,
                                "has shape " + shapeText(found->second.shape) +
                                    ", the network needs " + shapeText(slice.shape));
            for (float value : found->second.values)
                if (!std::isfinite(value))
                    throw FileError(path, place, "holds a value that is not finite");
            std::copy(found->second.values.begin(), found->second.values.end(),
                      block.begin() + slice.offset);
        }
        return block;
    };
    const bool moments = file.has("adam.m." + layout_.slices().front().name);
    const std::vector<float> values = gather("");
    std::vector<float> m, v;
    if (moments) {
        m = gather("adam.m.");
        v = gather("adam.v.");
    }
    upload(values);
    if (moments) {
        moment1_.upload(std::as_bytes(std::span(m)));
        moment2_.upload(std::as_bytes(std::span(v)));
    }
}

ParameterIds::ParameterIds(RenderGraph& graph, Parameters& parameters)
    : values(graph.importBuffer(parameters.values_)),
      gradient(graph.importBuffer(parameters.gradient_)),
      moment1(graph.importBuffer(parameters.moment1_)),
      moment2(graph.importBuffer(parameters.moment2_)),
      status(graph.importBuffer(parameters.status_)),
      counters(graph.importBuffer(parameters.counters_)), owner_(&parameters)
{
}

LayerWeights ParameterIds::weights(const std::string& layer) const
{
    return {values, owner_->layout_.slice(layer + ".weight").offset,
            owner_->layout_.slice(layer + ".bias").offset, true};
}

LayerWeights ParameterIds::gradients(const std::string& layer) const
{
    LayerWeights slices = weights(layer);
    slices.block = gradient;
    return slices;
}

void ParameterIds::clearGradients(RenderGraph& graph)
{
    PassBuilder pass = graph.addTransferPass("clear gradients");
    gradient = pass.write(gradient);
    status = pass.write(status);
    pass.fill(gradient, 0);
    pass.fill(status, 0);
    slots_ = 0;
}

void ParameterIds::checkFinite(RenderGraph& graph, const std::string& name, BufferId buffer,
                               std::uint32_t offset, std::uint32_t count, float limit)
{
    STRANDLIGHT_ASSERT(slots_ < gpu::kStatusSlots);
    PassBuilder pass = graph.addComputePass("check " + name);
    const BufferId from = pass.read(buffer);
    status = pass.write(status);
    // Parts that can be bound; their bindings begin where they may.
    constexpr std::uint32_t kStep = Binding::kAlignment / sizeof(float);
    const std::uint64_t most = graph.context().maxTensorBindingBytes() / sizeof(float) - kStep;
    const std::uint32_t end = offset + count;
    for (std::uint32_t first = offset; first < end;) {
        const std::uint32_t bound = first / kStep * kStep;
        const auto part = std::uint32_t(std::min<std::uint64_t>(most, end - first));
        const std::uint32_t quad = first % 4 == 0 && part % 4 == 0 ? 4 : 1;
        const std::uint32_t texels = part / quad;
        const std::uint32_t invocations = std::clamp(texels / 32 / 32, 1u, 2048u) * 32;
        checkTripBudget("finite_check", texels / invocations + 1);
        const gpu::FiniteCheckPush push{(first - bound) / quad, texels, invocations, slots_, limit};
        const Binding tested(from, bound * sizeof(float), (first - bound + part) * sizeof(float));
        pass.dispatch(kernels::finite_check, {invocations, 1, 1}, push,
                      {tested, quad == 4 ? tested : Binding(status), status}, {quad});
        first += part;
    }
    if (slots_ < owner_->slotNames_.size())
        owner_->slotNames_[slots_] = name;
    else
        owner_->slotNames_.push_back(name);
    ++slots_;
}

void ParameterIds::checkFinite(RenderGraph& graph, const std::string& name, const TensorId& whole)
{
    STRANDLIGHT_ASSERT(whole.whole());
    checkFinite(graph, name, whole.buffer, 0, std::uint32_t(whole.desc.elements()),
                std::numeric_limits<float>::max());
}

} // namespace strandlight
