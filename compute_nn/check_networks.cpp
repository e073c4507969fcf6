// `nn check` of the spherical-gaussian mixture and of the U-Net.
#include "compute_nn/check_file.hpp"

#include <algorithm>
#include <cmath>

#include "compute_nn/sg_mixture.hpp"
#include "compute_nn/unet.hpp"

namespace strandlight {

namespace {

double relativeDifference(float ours, float theirs)
{
    return std::abs(double(ours) - theirs) / std::max(std::abs(double(theirs)), 1e-30);
}

} // namespace

void checkSgMixture(Context& context, const VectorFile& file, CheckReport& report)
{
    const NamedTensor& raw = file.tensor("raw");
    const NamedTensor& directions = file.tensor("directions");
    if (raw.shape.size() != 3 || raw.shape[2] != 7 || raw.values.empty())
        file.refuse("tensor \"raw\"", "is not [N,L,7]");
    if (directions.shape.size() != 3 || directions.shape[0] != raw.shape[0] ||
        directions.shape[2] != 3 || directions.values.empty())
        file.refuse("tensor \"directions\"", "is not [N,D,3]");
    const SgMixtureDesc desc{.images = std::uint32_t(raw.shape[0]),
                             .lobes = std::uint32_t(raw.shape[1]),
                             .directions = std::uint32_t(directions.shape[1]),
                             .sharedDirections = false,
                             .planar = false};
    const TensorDesc radianceDesc{desc.images, desc.directions, 1, 3};

    RenderGraph graph(context);
    const TensorId rawId = uploadTensor(graph, "raw", desc.raw(), raw.values);
    const BufferId along =
        graph.uploadBuffer("directions", std::span<const float>(directions.values));
    const TensorId target =
        uploadTensor(graph, "target", radianceDesc, file.tensor("target", directions.shape).values);
    const TensorId lobes = addSgDecodePass(graph, desc, rawId);
    const TensorId radiance =
        sgMixtureForward(graph, desc, lobes, along, createTensor(graph, "radiance", radianceDesc));
    const LossResult loss = addLossPass(graph, "loss", LossKind::MeanSquare, radiance, target);
    const TensorId dRaw = sgMixtureBackward(graph, desc, rawId, along, loss.gradient,
                                            createTensor(graph, "d raw", desc.raw()));
    for (BufferId id : {radiance.buffer, loss.value, dRaw.buffer})
        graph.output(id);
    graph.execute();

    addRow(report, "radiance", graph.read<float>(radiance.buffer),
           file.tensor("radiance", directions.shape).values, kForwardTolerance);
    addRow(report, "loss", graph.read<float>(loss.value), file.tensor("loss", {1}).values,
           kForwardTolerance);
    addRow(report, "draw", graph.read<float>(dRaw.buffer), file.tensor("draw", raw.shape).values,
           kGradientTolerance);
}

void checkUNet(Context& context, const VectorFile& file, CheckReport& report)
{
    const UNetDesc net; // the defaults are the network of these files
    const TensorDesc xDesc = file.desc("x");
    net.check(xDesc);
    const TensorDesc yDesc{xDesc.n, net.out, xDesc.h, xDesc.w};
    if (file.desc("target") != yDesc || file.desc("y") != yDesc)
        file.refuse("tensor \"target\"", "target and y are not " + shapeText(yDesc));

    const ParameterLayout layout = net.parameters();
    std::vector<float> values(layout.count());
    for (const ParameterSlice& slice : layout.slices()) {
        const std::vector<float>& from = file.tensor(slice.name, slice.shape).values;
        std::copy(from.begin(), from.end(), values.begin() + slice.offset);
    }
    Parameters parameters(context, layout, 0);
    parameters.upload(values);

    const std::vector<float>& trace = file.tensor("losses").values;
    if (trace.empty())
        file.refuse("tensor \"losses\"", "is empty");
    double traceError = 0.0;
    for (std::uint32_t step = 1; step <= trace.size(); ++step) {
        RenderGraph graph(context);
        ParameterIds ids(graph, parameters);
        const TensorId x = uploadTensor(graph, "x", xDesc, file.tensor("x").values);
        const TensorId target = uploadTensor(graph, "target", yDesc, file.tensor("target").values);
        const UNetStep result = addUNetTrainingStep(graph, net, ids, x, target, {}, step);
        graph.output(result.loss);
        graph.output(result.y.buffer);
        graph.execute();
        const float loss = graph.read<float>(result.loss)[0];
        traceError = std::fmax(traceError, relativeDifference(loss, trace[step - 1]));
        if (!std::isfinite(loss))
            traceError = INFINITY;
        if (step > 1)
            continue;
        addRow(report, "y", graph.read<float>(result.y.buffer), file.tensor("y").values,
               kForwardTolerance);
        addRow(report, "loss", std::vector<float>{loss}, file.tensor("loss", {1}).values,
               kForwardTolerance);
        const std::vector<float> gradient = graph.read<float>(ids.gradient);
        for (const ParameterSlice& slice : layout.slices())
            addRow(report, "d." + slice.name,
                   std::span(gradient).subspan(slice.offset, slice.count),
                   file.tensor("d." + slice.name, slice.shape).values, kGradientTolerance);
    }
    report.rows.push_back(
        {"loss trace", traceError, kTraceTolerance, traceError <= kTraceTolerance});
}

} // namespace strandlight
