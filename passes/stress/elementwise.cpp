// Activations, losses and the optimiser under stress, through their public passes.
#include <cmath>
#include <limits>

#include "compute_nn/activation.hpp"
#include "compute_nn/adam.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/reference/activation.hpp"
#include "compute_nn/reference/adam.hpp"
#include "compute_nn/reference/loss.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/kernel_inputs.hpp"
#include "passes/stress/tally.hpp"

namespace strandlight {

namespace {

// Special values with both signs, then log-uniform ones with both signs.
std::vector<float> scalars(const StressSettings& s, std::uint32_t stream)
{
    std::vector<float> values;
    for (const float v : kSpecialValues) {
        values.push_back(v);
        values.push_back(-v);
    }
    while (values.size() < s.items) {
        StressRandom r(s.seed + stream, std::uint32_t(values.size()));
        const float size = r.logUniform(1e-30f, 1e4f);
        values.push_back(r.uniform() < 0.5f ? -size : size);
    }
    return values;
}

void stressActivation(Context& context, const Activation& a, const std::string& name,
                      const std::vector<float>& values, std::vector<StressRow>& rows)
{
    const TensorDesc desc{1, 1, 1, std::uint32_t(values.size())};
    RenderGraph graph(context);
    const std::vector<float> ones(values.size(), 1.0f), zeros(values.size(), 0.0f);
    const TensorId x = uploadTensor(graph, "x", desc, values);
    const TensorId y = activationForward(graph, "f", a, x, createTensor(graph, "y", desc));
    const TensorId dX = activationBackward(graph, "b", a, y, uploadTensor(graph, "dY", desc, ones),
                                           uploadTensor(graph, "dX", desc, zeros));
    graph.output(y.buffer);
    graph.output(dX.buffer);
    graph.run();
    const std::vector<float> gotY = graph.read<float>(y.buffer),
                             gotD = graph.read<float>(dX.buffer);

    Tally value(name + ", device", 1e-6, "value"), slope(name + " derivative, device", 1e-6, "1");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double in = double(values[i]);
        const auto text = [&] { return numberText(in); };
        if (!std::isfinite(in)) { // NaN must show, also in the derivative's factor y
            value.require(!std::isnan(in) || std::isnan(gotY[i]), text);
            continue;
        }
        const double expected = reference::activate<double>(a, in);
        value.compare(double(gotY[i]), expected, std::max(std::abs(expected), 1e-30), text);
        // A device may take subnormal numbers for zero: then a rectifier's slope is that of zero.
        const bool subnormal =
            in != 0.0 && std::abs(in) < double(std::numeric_limits<float>::min());
        const double slopeAtZero = reference::activationDerivative<double>(a, 0.0);
        if (subnormal && double(gotD[i]) == double(float(slopeAtZero)))
            slope.require(true, text);
        else
            slope.compare(double(gotD[i]), reference::activationDerivative<double>(a, expected),
                          1.0, text);
    }
    rows.push_back(value.row());
    rows.push_back(slope.row());
}

void stressLog1p(Context& context, const std::vector<float>& values, std::vector<StressRow>& rows)
{
    const TensorDesc desc{1, 1, 1, std::uint32_t(values.size())};
    RenderGraph graph(context);
    const TensorId y = log1pForward(graph, "log", uploadTensor(graph, "x", desc, values),
                                    createTensor(graph, "y", desc));
    graph.output(y.buffer);
    graph.run();
    const std::vector<float> got = graph.read<float>(y.buffer);
    Tally value("ln(1 + x), device", 1e-6, "value");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double in = double(values[i]);
        const auto text = [&] { return numberText(in); };
        if (!std::isfinite(in)) {
            value.require(!std::isnan(in) || std::isnan(got[i]), text);
            continue;
        }
        const double expected = std::log1p(std::max(in, 0.0));
        value.compare(double(got[i]), expected, std::max(expected, 1e-30), text);
    }
    rows.push_back(value.row());
}

// What rounding of prediction and target alone does to the derivative.
double lossScale(LossKind kind, double p, double t)
{
    const double larger = std::max(std::abs(p), std::abs(t));
    if (kind == LossKind::MeanSquare)
        return 2.0 * larger;
    if (kind == LossKind::Relative)
        return 2.0 * larger / (p * p + double(gpu::kRelativeLossFloor));
    const double q = std::max(p, 0.0);
    return 2.0 * (std::log1p(q) + std::log1p(std::max(t, 0.0))) / (1.0 + q);
}

void stressLoss(Context& context, LossKind kind, const std::string& name, const StressSettings& s,
                std::vector<StressRow>& rows)
{
    std::vector<float> p, t;
    for (std::uint32_t i = 0; i < s.items; ++i) {
        StressRandom r(s.seed + 70, i);
        const bool special = i < kSpecials * kSpecials;
        p.push_back(special ? specialValue(i, 0) : r.logUniform(1e-12f, 1e6f));
        t.push_back(special ? specialValue(i, 1) : i % 5 ? r.logUniform(1e-12f, 1e6f) : 0.0f);
    }
    const TensorDesc desc{1, 1, 1, std::uint32_t(p.size())};
    RenderGraph graph(context);
    const LossResult loss = addLossPass(graph, "loss", kind, uploadTensor(graph, "p", desc, p),
                                        uploadTensor(graph, "t", desc, t));
    graph.output(loss.gradient.buffer);
    graph.run();
    const std::vector<float> got = graph.read<float>(loss.gradient.buffer);
    Tally slope("loss " + name + ", derivative, device", 1e-6, "rounding of its inputs");
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto text = [&] {
            return numberText(double(p[i])) + " against " + numberText(double(t[i]));
        };
        if (!std::isfinite(p[i]) || !std::isfinite(t[i])) {
            slope.require(!std::isfinite(got[i]), text); // shows, and the optimiser refuses it
            continue;
        }
        const double expected =
            reference::lossTerm<double>(kind, double(p[i]), double(t[i])).derivative;
        if (std::abs(expected) / double(p.size()) > double(kLargestGradient)) {
            slope.refuse(); // the optimiser's own limit
            continue;
        }
        slope.compare(double(got[i]) * double(p.size()), expected,
                      std::max(lossScale(kind, double(p[i]), double(t[i])), 1e-26), text);
    }
    rows.push_back(slope.row());
}

} // namespace

std::vector<StressRow> stressElementwise(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    const std::vector<float> values = scalars(settings, 65);
    stressActivation(context, {ActivationKind::Relu}, "relu", values, rows);
    stressActivation(context, Activation::leakyRelu(0.1f), "leaky relu", values, rows);
    stressActivation(context, {ActivationKind::Softplus}, "softplus", values, rows);
    stressActivation(context, {ActivationKind::Sigmoid}, "sigmoid", values, rows);
    stressLog1p(context, values, rows);
    stressLoss(context, LossKind::MeanSquare, "mean square", settings, rows);
    stressLoss(context, LossKind::Relative, "relative", settings, rows);
    stressLoss(context, LossKind::Log1p, "ln(1 + x)", settings, rows);
    return rows;
}

} // namespace strandlight
