// The optimiser and the sums behind losses and bias gradients under stress.
#include <algorithm>
#include <cmath>

#include "compute_nn/adam.hpp"
#include "compute_nn/conv2d.hpp"
#include "compute_nn/loss.hpp"
#include "compute_nn/reference/adam.hpp"
#include "engine/base/error.hpp"
#include "passes/stress/inputs.hpp"
#include "passes/stress/kernel_inputs.hpp"
#include "passes/stress/tally.hpp"

namespace strandlight {

namespace {

// Parameters that start at zero, so that the rounding of a step is seen and not that of a large
// parameter.
ParameterLayout zeroLayout(std::uint32_t count)
{
    ParameterLayout layout;
    layout.add("block", {count}, 0);
    return layout;
}

void stepWith(Context& context, Parameters& parameters, const std::vector<float>& gradient,
              std::uint32_t step)
{
    RenderGraph graph(context);
    ParameterIds ids(graph, parameters);
    ids.clearGradients(graph);
    PassBuilder pass = graph.addTransferPass("gradient");
    const BufferId from = pass.read(graph.uploadBuffer("gradient", std::span(gradient)));
    ids.gradient = pass.write(ids.gradient);
    pass.copy(from, ids.gradient, gradient.size() * 4);
    addAdamPass(graph, ids, {}, step);
    graph.run();
}

void stressAdam(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    constexpr std::uint32_t kSteps = 5;
    const std::uint32_t count = std::min(s.items, 4096u);
    Parameters parameters(context, zeroLayout(count), 1);
    std::vector<double> values(count, 0.0), m(count, 0.0), v(count, 0.0);
    const auto gradientOf = [&](std::uint32_t step) {
        std::vector<float> gradient;
        for (std::uint32_t i = 0; i < count; ++i) {
            StressRandom r(s.seed + 100, i);
            const float size = i < kSpecials ? specialValue(i, 0) : r.logUniform(1e-25f, 1e18f);
            const bool usable = std::isfinite(size) && std::abs(size) <= kLargestGradient;
            gradient.push_back((i + step) % 3 == 0 ? -(usable ? size : 1.0f)
                                                   : (usable ? size : 1.0f));
        }
        return gradient;
    };
    for (std::uint32_t step = 1; step <= kSteps; ++step) {
        stepWith(context, parameters, gradientOf(step), step);
        (void)reference::adamStep<double>({}, step, toDouble(gradientOf(step)), values, m, v);
    }
    Tally value("Adam, five steps, device", 1e-5, "learning rate");
    const std::vector<float> got = parameters.download();
    for (std::uint32_t i = 0; i < count; ++i)
        value.compare(double(got[i]), values[i], AdamSettings{}.learningRate,
                      [&] { return "gradient " + numberText(double(gradientOf(1)[i])); });
    rows.push_back(value.row());

    Tally refusal("Adam, refused gradients, device", 0.0, "named, and nothing changed");
    std::uint32_t skipped = 0;
    for (const float poison : {1e19f, 1e30f, 3e38f, -INFINITY, INFINITY, NAN})
        for (const std::uint32_t at : {0u, count / 2, count - 1}) {
            std::vector<float> gradient = gradientOf(1);
            gradient[at] = poison;
            stepWith(context, parameters, gradient, kSteps + 1);
            const OptimizerReport report = parameters.report();
            refusal.require(
                parameters.download() == got && report.stepsSkipped == ++skipped &&
                    report.refusedIn == std::vector<std::string>{"gradient"},
                [&] { return numberText(double(poison)) + " at " + std::to_string(at); });
        }
    refusal.clamped(0);
    rows.push_back(refusal.row());
}

enum class Numbers
{
    Ones,
    Alternating, // +-1e4
    Exponential, // exp of uniform [-6, 6)
    Sorted       // the same, ascending: the last ones meet a large sum
};

std::vector<float> numbers(Numbers kind, std::uint32_t count, std::uint32_t seed)
{
    std::vector<float> values(count, 1.0f);
    for (std::uint32_t i = 0; i < count && kind != Numbers::Ones; ++i)
        values[i] = kind == Numbers::Alternating
                        ? (i % 2 ? -1e4f : 1e4f)
                        : std::exp(12.0f * gpu::uniformFloat(gpu::hashPcg(i ^ seed)) - 6.0f);
    if (kind == Numbers::Sorted)
        std::sort(values.begin(), values.end());
    return values;
}

struct Sums
{
    double loss = 0.0; // mean of squares
    double bias = 0.0; // sum
};

Sums sumOnDevice(Context& context, const std::vector<float>& values)
{
    const auto count = std::uint32_t(values.size());
    RenderGraph graph(context);
    std::uint32_t width = std::min(count, 32768u); // sides are limited: the widest that divides
    while (width > 1 && count % width != 0)
        --width;
    const TensorDesc desc{1, 1, count / std::max(width, 1u), width};
    const std::vector<float> zeros(values.size(), 0.0f), two(2, 0.0f);
    const TensorId x = uploadTensor(graph, "x", desc, values),
                   zero = uploadTensor(graph, "0", desc, zeros);
    const LossResult loss = addLossPass(graph, "loss", LossKind::MeanSquare, x, zero);
    const LayerWeights gradient{graph.uploadBuffer("gradient", std::span(two)), 0, 1, true};
    const Conv2dDesc conv{.kernel = {1, 1}, .padding = {0, 0}};
    const BufferId block = conv2dBackwardWeight(graph, "bias", conv, zero, x, gradient);
    graph.output(loss.value);
    graph.output(block);
    graph.run();
    return {double(graph.read<float>(loss.value)[0]), double(graph.read<float>(block)[1])};
}

void stressSums(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    Tally loss("sum behind a loss, device", 1e-6, "sum of magnitudes");
    Tally bias("sum behind a bias gradient, device", 1e-6, "sum of magnitudes");
    for (const std::uint32_t count :
         {0u, 1u, 7u, 8u, 9u, 255u, 256u, 257u, 65535u, 65536u, 1000000u, 10000000u})
        for (const Numbers kind :
             {Numbers::Ones, Numbers::Alternating, Numbers::Exponential, Numbers::Sorted}) {
            if (count > s.largest)
                continue;
            const std::vector<float> values = numbers(kind, count, s.seed);
            const auto text = [&] {
                return std::to_string(count) + " values, distribution " + std::to_string(int(kind));
            };
            if (count == 0) { // nothing to sum is an error of the caller, and said so
                try {
                    (void)sumOnDevice(context, values);
                    loss.require(false, text);
                } catch (const Error&) {
                    loss.refuse();
                    bias.refuse();
                }
                continue;
            }
            double squares = 0.0, sum = 0.0, sizes = 0.0;
            for (const float v : values) {
                squares += double(v) * double(v);
                sum += double(v);
                sizes += std::abs(double(v));
            }
            const Sums got = sumOnDevice(context, values);
            loss.compare(got.loss, squares / count, squares / count, text);
            bias.compare(got.bias, sum, sizes, text);
        }
    rows.push_back(loss.row());
    rows.push_back(bias.row());
}

} // namespace

std::vector<StressRow> stressOptimiser(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    stressAdam(context, settings, rows);
    stressSums(context, settings, rows);
    return rows;
}

} // namespace strandlight
