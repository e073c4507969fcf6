// `nn check` of single layers.
#include "compute_nn/check_file.hpp"

#include "compute_nn/conv2d.hpp"
#include "compute_nn/conv_transpose2d.hpp"

namespace strandlight {

namespace {

// A layer as the file describes it; of the two descriptions the op's own is used.
struct FileLayer
{
    TensorDesc x;
    bool transposed = false;
    Conv2dDesc conv;
    ConvTranspose2dDesc transpose;
    TensorDesc y;
};

FileLayer readLayer(const VectorFile& file, bool transposed, bool onnx)
{
    FileLayer layer;
    layer.transposed = transposed;
    layer.x = file.desc("x");
    const TensorDesc weight = file.desc("weight"); // [O,I,Kh,Kw], transposed [I,O,Kh,Kw]
    const Extent2 kernel = {weight.h, weight.w};
    if (!(file.pair(onnx ? "kernel_shape" : "kernel") == kernel))
        file.refuse("tensor \"weight\"", "has another kernel size than the metadata");
    Extent2 stride, padding, outputPadding = {0, 0};
    if (onnx) {
        if (file.numbers("dilations") != std::vector<std::uint32_t>{1, 1} ||
            file.pair("group") != Extent2{1, 1})
            file.refuse("__metadata__", "dilation and groups are not supported");
        const auto pads = file.numbers("pads"); // top, left, bottom, right
        if (pads.size() != 4 || pads[0] != pads[2] || pads[1] != pads[3])
            file.refuse("__metadata__ \"pads\"",
                        "only equal padding on opposite sides is supported");
        stride = file.pair("strides");
        padding = {pads[0], pads[1]};
        if (file.hasField("output_padding"))
            outputPadding = file.pair("output_padding");
    } else {
        stride = file.pair("stride");
        padding = file.pair("padding");
    }
    const std::uint32_t in = transposed ? weight.n : weight.c,
                        out = transposed ? weight.c : weight.n;
    layer.conv = {.in = in, .out = out, .kernel = kernel, .stride = stride, .padding = padding};
    layer.transpose = {.in = in,
                       .out = out,
                       .kernel = kernel,
                       .stride = stride,
                       .padding = padding,
                       .outputPadding = outputPadding};
    layer.y = transposed ? layer.transpose.output(layer.x) : layer.conv.output(layer.x);
    if (file.desc("y") != layer.y)
        file.refuse("tensor \"y\"", "has shape " + shapeText(file.desc("y")) +
                                        ", the layer gives " + shapeText(layer.y));
    return layer;
}

} // namespace

void checkConv(Context& context, const VectorFile& file, CheckReport& report, bool transposed,
               bool onnx)
{
    const FileLayer layer = readLayer(file, transposed, onnx);
    const bool hasBias = file.has("bias");
    std::vector<float> block = file.tensor("weight").values; // weight, then bias
    const std::uint32_t weightCount = std::uint32_t(block.size());
    const auto& bias = hasBias ? file.tensor("bias", {layer.y.c}).values : std::vector<float>();
    block.insert(block.end(), bias.begin(), bias.end());

    RenderGraph graph(context);
    const TensorId x = uploadTensor(graph, "x", layer.x, file.tensor("x").values);
    const LayerWeights weights{graph.uploadBuffer("weights", std::span<const float>(block)), 0,
                               weightCount, hasBias};
    TensorId y = createTensor(graph, "y", layer.y);
    y = transposed ? convTranspose2dForward(graph, "forward", layer.transpose, x, weights, y)
                   : conv2dForward(graph, "forward", layer.conv, x, weights, y);
    graph.output(y.buffer);

    const bool backward = file.has("dy");
    TensorId dX;
    LayerWeights gradient = weights;
    if (backward) {
        if (file.desc("dy") != layer.y)
            file.refuse("tensor \"dy\"", "has another shape than y");
        const TensorId dY = uploadTensor(graph, "dY", layer.y, file.tensor("dy").values);
        const std::vector<float> zeros(block.size(), 0.0f);
        gradient.block = graph.uploadBuffer("gradients", std::span<const float>(zeros));
        dX = createTensor(graph, "dX", layer.x);
        if (transposed) {
            dX = convTranspose2dBackwardInput(graph, "dX", layer.transpose, dY, weights, dX);
            gradient.block =
                convTranspose2dBackwardWeight(graph, "dW", layer.transpose, x, dY, gradient);
        } else {
            dX = conv2dBackwardInput(graph, "dX", layer.conv, dY, weights, dX);
            gradient.block = conv2dBackwardWeight(graph, "dW", layer.conv, x, dY, gradient);
        }
        graph.output(dX.buffer);
        graph.output(gradient.block);
    }
    graph.execute();

    addRow(report, "y", graph.read<float>(y.buffer), file.tensor("y").values, kForwardTolerance);
    if (!backward)
        return;
    const std::vector<float> dW = graph.read<float>(gradient.block);
    const auto parts = std::span<const float>(dW);
    addRow(report, "dx", graph.read<float>(dX.buffer),
           file.tensor("dx", file.tensor("x").shape).values, kGradientTolerance);
    addRow(report, "dweight", parts.first(weightCount),
           file.tensor("dweight", file.tensor("weight").shape).values, kGradientTolerance);
    if (hasBias)
        addRow(report, "dbias", parts.subspan(weightCount, bias.size()),
               file.tensor("dbias", {layer.y.c}).values, kGradientTolerance);
}

} // namespace strandlight
