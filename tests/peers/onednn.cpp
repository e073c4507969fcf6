// Times the convolutions of `strandlight bench kernels` in oneDNN, each in three layouts:
// name,layout,milliseconds of the forward pass,of the weight gradient (median of nine).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <unordered_map>
#include <vector>

#include <oneapi/dnnl/dnnl.hpp>

namespace {

using dnnl::memory;
using Arguments = std::unordered_map<int, memory>;

constexpr int kRuns = 9;

struct Layer
{
    const char* name;
    int width, height, in, out, kernel, stride, padding;
    bool transposed;
};
const Layer kLayers[] = {{"conv 3x3 24->32 640x360", 640, 360, 24, 32, 3, 1, 1, false},
                         {"conv 3x3 24->16 640x360", 640, 360, 24, 16, 3, 1, 1, false},
                         {"conv 2x2 s2 24->16 640x360", 640, 360, 24, 16, 2, 2, 0, false},
                         {"conv 4x4 s2 24->32 640x360", 640, 360, 24, 32, 4, 2, 1, false},
                         {"conv 3x3 s2 32->64 320x180", 320, 180, 32, 64, 3, 2, 1, false},
                         {"conv 3x3 64->64 160x90", 160, 90, 64, 64, 3, 1, 1, false},
                         {"conv 3x3 24->3 640x360", 640, 360, 24, 3, 3, 1, 1, false},
                         {"transposed conv 4x4 s2 64->32 160x90", 160, 90, 64, 32, 4, 2, 1, true},
                         {"transposed conv 4x4 s2 32->16 320x180", 320, 180, 32, 16, 4, 2, 1, true},
                         {"transposed conv 2x2 s2 64->32 160x90", 160, 90, 64, 32, 2, 2, 0, true},
                         // The layers of the U-Net at 640x384.
                         {"unet enc0", 640, 384, 24, 16, 3, 1, 1, false},
                         {"unet enc1", 640, 384, 16, 16, 3, 2, 1, false},
                         {"unet enc2", 320, 192, 16, 32, 3, 2, 1, false},
                         {"unet enc3", 160, 96, 32, 64, 3, 2, 1, false},
                         {"unet enc4", 80, 48, 64, 64, 3, 2, 1, false},
                         {"unet dec3", 40, 24, 64, 64, 4, 2, 1, true},
                         {"unet dec2", 80, 48, 128, 32, 4, 2, 1, true},
                         {"unet dec1", 160, 96, 64, 16, 4, 2, 1, true},
                         {"unet dec0", 320, 192, 32, 16, 4, 2, 1, true},
                         {"unet out", 640, 384, 32, 3, 3, 1, 1, false}};

struct Layout
{
    const char* name;
    memory::format_tag tag;
};
const Layout kLayouts[] = {{"nhwc", memory::format_tag::nhwc},
                           {"blocked", memory::format_tag::any},
                           {"nchw", memory::format_tag::nchw}};

struct Descriptions
{
    memory::desc source, weights, bias, result;
};

memory filled(const dnnl::engine& engine, const memory::desc& desc)
{
    memory m(desc, engine);
    float* values = static_cast<float*>(m.get_data_handle());
    for (std::size_t i = 0; i < desc.get_size() / sizeof(float); ++i)
        values[i] = float(i % 17) * 0.05f - 0.4f;
    return m;
}

double median(dnnl::stream& stream, const dnnl::primitive& primitive, const Arguments& arguments)
{
    std::vector<double> milliseconds;
    for (int run = 0; run <= kRuns; ++run) { // the first warms up
        const auto start = std::chrono::steady_clock::now();
        primitive.execute(stream, arguments);
        stream.wait();
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - start;
        if (run > 0)
            milliseconds.push_back(elapsed.count());
    }
    std::sort(milliseconds.begin(), milliseconds.end());
    return milliseconds[kRuns / 2];
}

Descriptions describe(const Layer& l, memory::format_tag tag)
{
    const int outWidth = l.transposed ? (l.width - 1) * l.stride - 2 * l.padding + l.kernel
                                      : (l.width + 2 * l.padding - l.kernel) / l.stride + 1;
    const int outHeight = l.transposed ? (l.height - 1) * l.stride - 2 * l.padding + l.kernel
                                       : (l.height + 2 * l.padding - l.kernel) / l.stride + 1;
    const auto f32 = memory::data_type::f32;
    return {memory::desc({1, l.in, l.height, l.width}, f32, tag),
            memory::desc({l.out, l.in, l.kernel, l.kernel}, f32, memory::format_tag::any),
            memory::desc({l.out}, f32, memory::format_tag::x),
            memory::desc({1, l.out, outHeight, outWidth}, f32, tag)};
}

// Forward and weight gradient of one operation type; `attributes` are of the forward pass.
template <class Forward, class BackwardWeights>
void time(const Layer& l, const Layout& layout, dnnl::algorithm algorithm,
          const dnnl::primitive_attr& attributes)
{
    const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
    dnnl::stream stream(engine);
    const Descriptions d = describe(l, layout.tag);
    const memory::dims strides = {l.stride, l.stride}, padding = {l.padding, l.padding};
    const typename Forward::primitive_desc forward({dnnl::prop_kind::forward_training, algorithm,
                                                    d.source, d.weights, d.bias, d.result, strides,
                                                    padding, padding},
                                                   attributes, engine);
    const double forwardMs = median(stream, Forward(forward),
                                    {{DNNL_ARG_SRC, filled(engine, forward.src_desc())},
                                     {DNNL_ARG_WEIGHTS, filled(engine, forward.weights_desc())},
                                     {DNNL_ARG_BIAS, filled(engine, d.bias)},
                                     {DNNL_ARG_DST, filled(engine, forward.dst_desc())}});
    const typename BackwardWeights::primitive_desc backward(
        {algorithm, d.source, d.weights, d.bias, d.result, strides, padding, padding}, engine,
        forward);
    const double backwardMs =
        median(stream, BackwardWeights(backward),
               {{DNNL_ARG_SRC, filled(engine, backward.src_desc())},
                {DNNL_ARG_DIFF_WEIGHTS, filled(engine, backward.diff_weights_desc())},
                {DNNL_ARG_DIFF_BIAS, filled(engine, d.bias)},
                {DNNL_ARG_DIFF_DST, filled(engine, backward.diff_dst_desc())}});
    std::printf("%s,%s,%.4f,%.4f\n", l.name, layout.name, forwardMs, backwardMs);
    std::fflush(stdout);
}

} // namespace

int main()
{
    std::printf("name,layout,forward_ms,weight_gradient_ms\n");
    dnnl::post_ops relu;
    relu.append_eltwise(1.0f, dnnl::algorithm::eltwise_relu, 0.0f, 0.0f);
    dnnl::primitive_attr withRelu;
    withRelu.set_post_ops(relu);
    for (const Layer& layer : kLayers)
        for (const Layout& layout : kLayouts) {
            if (layer.transposed) // a ReLU would make it 3 to 10 times slower (README.md)
                time<dnnl::deconvolution_forward, dnnl::deconvolution_backward_weights>(
                    layer, layout, dnnl::algorithm::deconvolution_direct, {});
            else
                time<dnnl::convolution_forward, dnnl::convolution_backward_weights>(
                    layer, layout, dnnl::algorithm::convolution_direct, withRelu);
        }
    return 0;
}
