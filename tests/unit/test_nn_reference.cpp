// The CPU twins judge the kernels, so they are judged first: here by finite differences in double.
#include <doctest/doctest.h>

#include <functional>
#include <numeric>

#include "compute_nn/reference/adam.hpp"
#include "compute_nn/reference/conv2d.hpp"
#include "compute_nn/reference/kernel_filter.hpp"
#include "compute_nn/reference/loss.hpp"
#include "compute_nn/reference/networks.hpp"
#include "compute_nn/reference/sg_mixture.hpp"
#include "tests/nn/compare.hpp"
#include "tests/nn/conv_cases.hpp"

using namespace strandlight;
using namespace strandlight::test;

namespace {

using Values = std::vector<double>;

double dot(const Values& a, const Values& b)
{
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Compares `gradient` of f with four-point differences at up to `checks` elements of x.
// A step of 1e-3 leaves a truncation error of about h^4 = 1e-12 and a rounding error of about 1e-13
// |f|, so the tolerances can be far below PyTorch's gradcheck (1e-5 absolute, 1e-3 relative).
void checkGradient(const std::string& what, Values x, const Values& gradient,
                   const std::function<double(const Values&)>& f, std::size_t checks = 4,
                   double h = 1e-3)
{
    CAPTURE(what);
    REQUIRE_EQ(x.size(), gradient.size());
    const std::size_t stride = std::max<std::size_t>(1, x.size() / checks);
    for (std::size_t i = 0; i < x.size(); i += stride) {
        const double at = x[i];
        const auto value = [&](double offset) {
            x[i] = at + offset;
            return f(x);
        };
        const double numeric =
            (value(-2 * h) - 8 * value(-h) + 8 * value(h) - value(2 * h)) / (12 * h);
        x[i] = at;
        CAPTURE(i);
        CHECK_LE(std::abs(numeric - gradient[i]), 1e-8 + 1e-6 * std::abs(numeric));
    }
}

// A convolution is linear in x, in its weights and in its bias, so a difference of any step is a
// derivative but for rounding. Along a random direction all elements are checked at once.
void checkAlong(const std::string& what, const Values& x, const Values& gradient,
                std::uint32_t seed, const std::function<double(const Values&)>& f)
{
    CAPTURE(what);
    REQUIRE_EQ(x.size(), gradient.size());
    const Values along = randomValues<double>(x.size(), seed);
    const auto value = [&](double step) {
        Values moved = x;
        for (std::size_t i = 0; i < x.size(); ++i)
            moved[i] += step * along[i];
        return f(moved);
    };
    double size = 0.0; // what rounding is relative to
    for (std::size_t i = 0; i < x.size(); ++i)
        size += std::abs(gradient[i] * along[i]);
    CHECK_LE(std::abs((value(0.5) - value(-0.5)) - dot(gradient, along)), 1e-11 * (1.0 + size));
}

template <class Desc, class Forward, class Backward>
void checkConv(const Desc& d, const TensorDesc& xDesc, Forward forward, Backward backward,
               std::uint32_t seed, bool elements)
{
    const TensorDesc yDesc = d.output(xDesc);
    CAPTURE(shapeText(xDesc));
    CAPTURE(shapeText(yDesc));
    CAPTURE(seed);
    const Values x = randomValues<double>(xDesc.elements(), seed);
    const Values w = randomValues<double>(d.weightElements(), seed + 1);
    const Values b = randomValues<double>(d.out, seed + 2);
    const Values dY = randomValues<double>(yDesc.elements(), seed + 3);
    const auto value = [&](const Values& vx, const Values& vw, const Values& vb) {
        Values y(yDesc.elements());
        forward(d, xDesc, vx, vw, vb, y);
        return dot(y, dY);
    };
    // Gradients accumulate: start at 1 and expect it back.
    Values dX(x.size(), 1.0), dW(w.size(), 1.0), dB(b.size(), 1.0);
    backward(d, xDesc, x, w, dY, dX, dW, dB);
    for (Values* v : {&dX, &dW, &dB})
        for (double& g : *v)
            g -= 1.0;
    const auto ofX = [&](const Values& v) { return value(v, w, b); };
    const auto ofW = [&](const Values& v) { return value(x, v, b); };
    const auto ofB = [&](const Values& v) { return value(x, w, v); };
    checkAlong("x", x, dX, seed + 4, ofX);
    checkAlong("weight", w, dW, seed + 5, ofW);
    checkAlong("bias", b, dB, seed + 6, ofB);
    if (!elements)
        return;
    checkGradient("x", x, dX, ofX);
    checkGradient("weight", w, dW, ofW);
    checkGradient("bias", b, dB, ofB);
}

} // namespace

TEST_CASE("conv2d and conv_transpose2d: gradients equal finite differences over 200 random shapes")
{
    std::uint32_t seed = 1;
    const auto check = [&](const ConvCase& c, bool elements) {
        seed += 10;
        checkConv(c.conv, c.x, reference::conv2d<double>, reference::conv2dBackward<double>, seed,
                  elements);
        checkConv(c.transpose, c.x, reference::convTranspose2d<double>,
                  reference::convTranspose2dBackward<double>, seed, elements);
    };
    for (const ConvCase& c : awkwardConvCases())
        check(c, true);
    const std::vector<ConvCase> cases = randomConvCases(200);
    for (std::size_t i = 0; i < cases.size(); ++i)
        check(cases[i], i < 20); // single elements too, of some
}

TEST_CASE("dense is a matrix product")
{
    const Values x = {1, 2}, w = {3, 4, 5, 6, 7, 8}, b = {10, 20, 30};
    Values y(3);
    reference::dense<double>(1, 2, 3, x, w, b, y);
    CHECK_EQ(y, Values{21, 37, 53});
}

TEST_CASE("activations: gradients equal finite differences, extremes stay finite")
{
    for (const Activation& a :
         {Activation{ActivationKind::Relu}, Activation::leakyRelu(0.1f),
          Activation{ActivationKind::Softplus}, Activation{ActivationKind::Sigmoid}}) {
        // Away from the kink of the relus, where no derivative exists.
        Values x = randomValues<double>(40, 5, -6.0f, 6.0f);
        for (double& v : x)
            v += v > 0 ? 0.01 : -0.01;
        const Values dY = randomValues<double>(40, 6);
        Values y(x.size()), dX(x.size(), 0.0);
        reference::activationForward<double>(a, x, y);
        reference::activationBackward<double>(a, y, dY, dX);
        checkGradient("activation", x, dX, [&](const Values& v) {
            Values out(v.size());
            reference::activationForward<double>(a, v, out);
            return dot(out, dY);
        });
    }
    for (double x : {0.0, 1e-8, -1e-8, 20.0, -20.0, 88.0, 100.0, -100.0, 1e4, -1e4}) {
        CAPTURE(x);
        CHECK(std::isfinite(reference::softplus(float(x))));
        CHECK(std::isfinite(reference::sigmoid(float(x))));
    }
    CHECK_EQ(reference::softplus(-20.0), doctest::Approx(2.0611536181902037e-9).epsilon(1e-12));
    CHECK(std::isnan(reference::softplus(NAN)));
    CHECK(std::isnan(reference::activate(Activation{ActivationKind::Relu}, NAN)));
}

TEST_CASE("SG mixture: gradients equal finite differences through the decoder")
{
    Values raw = randomValues<double>(3 * 7, 8, -2.0f, 2.0f);
    raw[3] = 10.0; // beyond the clamp: no gradient
    const Values direction = {0.36, 0.48, 0.8}, dOut = {0.7, -1.3, 0.4};
    const auto value = [&](const Values& v) {
        Values rgb(3, 0.0);
        reference::sgMixture<double>(v, direction, rgb);
        return dot(rgb, dOut);
    };
    Values dRaw(raw.size(), 0.0);
    reference::sgMixtureBackward<double>(raw, direction, dOut, dRaw);
    checkGradient("raw", raw, dRaw, value, raw.size());
    CHECK_EQ(dRaw[3], 0.0);
}

TEST_CASE("predicted kernel: gradient equals finite differences; a constant image stays constant")
{
    const TensorDesc image{2, 4, 5, 3};
    const std::size_t taps = std::size_t(image.n) * gpu::kFilterTaps * image.pixels();
    const Values logits = randomValues<double>(taps, 15, -2.0f, 2.0f);
    const Values x = randomValues<double>(image.elements(), 16);
    const Values dY = randomValues<double>(image.elements(), 17);
    Values dLogits(taps);
    reference::kernelFilterBackward<double>(image, logits, x, dY, dLogits);
    checkGradient(
        "logits", logits, dLogits,
        [&](const Values& v) {
            Values y(x.size());
            reference::kernelFilter<double>(image, v, x, y);
            return dot(y, dY);
        },
        90);
    Values y(x.size());
    reference::kernelFilter<double>(image, logits, Values(x.size(), 0.7), y);
    for (double v : y)
        CHECK_EQ(v, doctest::Approx(0.7).epsilon(1e-14));
}

TEST_CASE("SG decoder: axes that cannot be normalised naively")
{
    for (float scale : {0.0f, 1e-38f, 1e-20f, 1.0f, 1e20f, 3e38f}) {
        CAPTURE(scale);
        const std::vector<float> raw = {scale, 0, 0, 0, 0, 0, 0};
        const reference::Lobe<float> lobe = reference::decodeLobe<float>(raw);
        CHECK_EQ(lobe.axis[0], scale > 1e-30f ? 1.0f : 0.0f);
        CHECK_EQ(lobe.axis[2], scale > 1e-30f ? 0.0f : 1.0f);
        std::vector<float> dRaw(7, 0.0f);
        reference::decodeLobeBackward<float>(raw, {{0, 1, 0}, 1.0f, {1, 1, 1}}, dRaw);
        for (float g : dRaw)
            CHECK(std::isfinite(g));
    }
    const std::vector<float> bad = {NAN, 0, 0, 0, 0, 0, 0};
    CHECK(std::isnan(reference::decodeLobe<float>(bad).axis[2])); // never swallowed
}

TEST_CASE("losses: gradients equal finite differences; black and huge elements stay finite")
{
    const Values p = randomValues<double>(24, 9, 0.1f, 3.0f);
    const Values t = randomValues<double>(24, 10, 0.0f, 3.0f);
    const Values weights = {0.5, 2.0, 1.0};
    for (LossKind kind : {LossKind::MeanSquare, LossKind::Log1p}) {
        Values dP(p.size(), 0.0);
        (void)reference::loss<double>(kind, p, t, weights, 4, dP);
        checkGradient("prediction", p, dP, [&](const Values& v) {
            return reference::loss<double>(kind, v, t, weights, 4, {});
        });
    }
    // The relative loss holds its denominator fixed: differences of the numerator alone.
    Values dP(p.size(), 0.0);
    (void)reference::loss<double>(LossKind::Relative, p, t, {}, 1, dP);
    checkGradient("relative", p, dP, [&](const Values& v) {
        double sum = 0.0;
        for (std::size_t i = 0; i < v.size(); ++i)
            sum += (v[i] - t[i]) * (v[i] - t[i]) / (p[i] * p[i] + gpu::kRelativeLossFloor);
        return sum / double(v.size());
    });
    for (LossKind kind : {LossKind::Relative, LossKind::Log1p})
        for (double a : {0.0, 1e-8, 1.0, 6e4, 1e15})
            for (double b : {0.0, 1e-8, 1.0, 6e4, 1e15}) {
                const auto term = reference::lossTerm(kind, float(a), float(b));
                CHECK(std::isfinite(term.value));
                CHECK(std::isfinite(term.derivative));
            }
}

TEST_CASE("Adam: against the formula, and refuses what would poison the weights")
{
    const AdamSettings settings;
    for (double g : {1e-25, 1e-12, 1.0, 1e10}) {
        CAPTURE(g);
        Values p = {1.0}, m = {0.0}, v = {0.0};
        REQUIRE(reference::adamStep<double>(settings, 1, Values{g}, p, m, v));
        // After one step the corrected moments are g and g^2.
        CHECK_EQ(p[0], doctest::Approx(1.0 - 1e-3 * g / (g + 1e-8)).epsilon(1e-12));
    }
    for (float bad : {NAN, INFINITY, -INFINITY, 2e19f}) {
        std::vector<float> p = {1, 2}, m = {0, 0}, v = {0, 0};
        CHECK_FALSE(
            reference::adamStep<float>(settings, 1, std::vector<float>{1.0f, bad}, p, m, v));
        CHECK_EQ(p, std::vector<float>{1, 2});
        CHECK_EQ(m, std::vector<float>{0, 0});
    }
    const AdamStep first = adamStepConstants(settings, 1);
    CHECK_EQ(first.stepSize, doctest::Approx(1e-3 / (1.0 - 0.9)).epsilon(1e-14));
}

TEST_CASE("encoder: gradients of the whole network equal finite differences")
{
    const EncoderDesc net{.imageSize = 8, .lobes = 2};
    const Values parameters = convert<double>(net.parameters().initialValues(3));
    const Values image = randomValues<double>(2 * 3 * 64, 11, 0.0f, 2.0f);
    Values directions = randomValues<double>(64 * 3, 12);
    for (std::size_t d = 0; d < 64; ++d) {
        const double length =
            std::hypot(directions[3 * d], directions[3 * d + 1], directions[3 * d + 2]);
        for (std::size_t k = 0; k < 3; ++k)
            directions[3 * d + k] /= length;
    }
    const auto run = [&](const Values& p) {
        return reference::encoder<double>(net, p, 2, image, directions, {}, LossKind::Log1p);
    };
    const auto result = run(parameters);
    // A kink of the relu may fall between two evaluations; of this seed none does.
    checkGradient(
        "parameters", parameters, result.gradient, [&](const Values& v) { return run(v).loss; },
        60);
}

TEST_CASE("U-Net: gradients of every form of it equal finite differences")
{
    // The filters' forms with few channels: two levels and a head, three without one, four with
    // 4x4 kernels. Tiny pictures, so that every tap meets a border.
    UNetDesc headless{.in = 3, .out = 2, .head = 0, .down = {2, 3, 2}, .up = {3, 2, 2}};
    UNetDesc deep{.in = 2, .out = 1, .head = 2, .down = {2, 3, 2, 2}, .up = {2, 3, 2, 2}};
    deep.upKernel = 4;
    for (const UNetDesc& net :
         {UNetDesc{.in = 2, .out = 3, .head = 3, .down = {2, 4}, .up = {3, 2}}, headless, deep}) {
        const std::uint32_t side = 1u << net.levels();
        const TensorDesc x{2, net.in, side, 2 * side};
        CAPTURE(shapeText(x));
        const Values parameters = convert<double>(net.parameters().initialValues(4));
        const Values image = randomValues<double>(x.elements(), 13, 0.0f, 1.0f);
        const Values target = randomValues<double>(2 * std::size_t(net.out) * x.pixels(), 14);
        const auto run = [&](const Values& p) {
            return reference::unet<double>(net, p, x, image, target);
        };
        // Leaky relus have kinks; a step of 1e-6 rarely crosses one (and with these seeds does
        // not), and still leaves a rounding error of only 1e-10.
        checkGradient(
            "parameters", parameters, run(parameters).gradient,
            [&](const Values& v) { return run(v).loss; }, 60, 1e-6);
    }
}
