// Integrals of a spherical gaussian over hemispheres, its mean length, and the error function under
// stress.
#include "passes/stress/lobe_integrals.hpp"
#include "passes/stress/both.hpp"
#include "passes/stress/reference.hpp"

namespace strandlight {

namespace {

constexpr float kSharpest = gpu::kSgMaxSharpness;

// Cosines anywhere, at the poles, and close to the horizon.
gpu::StressInput lobeAboveHorizon(std::uint32_t seed, std::uint32_t i)
{
    StressRandom r(seed, i);
    const float lambda = r.logUniform(1e-8f, kSharpest);
    const float sign = r.uniform() < 0.5f ? -1.0f : 1.0f;
    const float small = r.logUniform(1e-7f, 1.0f);
    const float cosine = i % 4 == 0   ? r.uniform(-1.0f, 1.0f)
                         : i % 4 == 1 ? sign * small
                         : i % 4 == 2 ? sign * (1.0f - small)
                                      : sign;
    return {{cosine, 0.0f, 0.0f, lambda}, {}, {}, {}};
}

// `model`: the closed form's own error, in double. `rounding`: what fp32 adds.
struct HemisphereTolerances
{
    double model;
    double rounding;
};

template <class Expected>
void stressHemisphere(Context& context, std::uint32_t function, const std::string& name,
                      const HemisphereTolerances& tolerance, double upperBound,
                      std::span<const gpu::StressInput> items, Expected expected,
                      std::vector<StressRow>& rows)
{
    Tally model(name + ", closed form against quadrature", tolerance.model, "energy of the lobe");
    for (std::size_t i = 0; i < items.size(); i += 5) // quadrature takes its time
        model.compare(stressInDouble(function, items[i]).x.x,
                      expected(double(items[i].a.w), double(items[i].a.x)),
                      reference::sgIntegral(double(items[i].a.w)),
                      [&] { return describe(items[i]); });
    rows.push_back(model.row());

    Tallies value = tallies(name, tolerance.rounding, "energy of the lobe");
    onBoth(context, function, items, [&](auto m, auto, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        const double energy = reference::sgIntegral(double(item.a.w));
        value[m].compare(double(out.x.x), stressInDouble(function, item).x.x, energy, text);
        value[m].bound(double(out.x.x), 0.0, std::min(energy, upperBound) * (1.0 + 2e-6), text);
        value[m].bound(double(out.x.y), 0.0, 1.0, text); // the share, or nothing
    });
    append(rows, value);

    const auto special = makeItems(kSpecials * kSpecials, [](std::uint32_t i) {
        return gpu::StressInput{{specialValue(i, 0), 0.0f, 0.0f, specialValue(i, 1)}, {}, {}, {}};
    });
    Tallies bounds = tallies(name + ", special values", 0.0, "in [0, energy]");
    onBoth(context, function, special, [&](auto m, auto, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        if (inRange(item.a.x, -1.0f, 1.0f) && inRange(item.a.w, 0.0f, kSharpest))
            bounds[m].bound(double(out.x.x), 0.0, upperBound * (1.0 + 2e-6), text);
        else
            bounds[m].refuse();
    });
    append(rows, bounds);
}

void stressMeanLength(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items, [&](std::uint32_t i) {
        StressRandom r(s.seed + 11, i);
        const float length = i % 2 ? r.logUniform(1e-6f, 0.5f) : 1.0f - r.logUniform(2e-5f, 0.5f);
        return gpu::StressInput{{length, 0.0f, 0.0f, r.logUniform(1e-6f, kSharpest)}, {}, {}, {}};
    });
    Tallies length = tallies("sg mean length", 4e-6, "value");
    Tallies sharpness = tallies("sg sharpness from mean length", 2e-5, "value");
    onBoth(context, gpu::kStressMeanLength, items,
           [&](auto m, auto, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               const double r = reference::sgMeanLength(double(item.a.w));
               length[m].compare(double(out.x.x), r, r, text);
               const double lambda = reference::sgSharpness(double(item.a.x));
               sharpness[m].compare(double(out.x.y), lambda, lambda, text);
           });
    append(rows, length);
    append(rows, sharpness);
}

void stressErrorFunction(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items + kSpecials, [&](std::uint32_t i) {
        StressRandom r(s.seed + 12, i);
        const float x = i < kSpecials ? specialValue(i, 0)
                        : i % 2       ? r.uniform(-8.0f, 8.0f)
                                      : r.logUniform(1e-38f, 1.0f);
        return gpu::StressInput{{x, 0.0f, 0.0f, 0.0f}, {}, {}, {}};
    });
    Tallies erf = tallies("erf", 4e-7, "value");
    Tallies erfc = tallies("erfc", 2e-5, "value");
    onBoth(context, gpu::kStressErf, items, [&](auto m, auto, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        const double x = double(item.a.x);
        if (!std::isfinite(x)) {
            erf[m].refuse(double(out.x.x), -1.0, 1.0, text);
            return erfc[m].refuse(double(out.x.y), 0.0, 2.0, text);
        }
        // A device may take subnormal numbers, below 1.2e-38, for zero: the smallest scale at
        // which that error is within the tolerance.
        erf[m].compare(double(out.x.x), std::erf(x), std::max(std::abs(std::erf(x)), 4e-32), text);
        erfc[m].compare(double(out.x.y), std::erfc(x), std::max(std::erfc(x), 1e-30), text);
    });
    append(rows, erf);
    append(rows, erfc);
}

} // namespace

void stressLobeIntegrals(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items =
        makeItems(s.items, [&](std::uint32_t i) { return lobeAboveHorizon(s.seed + 10, i); });
    stressHemisphere(
        context, gpu::kStressHemisphere, "sg over a hemisphere", {5e-3, 4e-6},
        4.0 * reference::kPi64, items,
        [](double lambda, double c) { return reference::sgHemisphere(lambda, c).plain; }, rows);
    stressHemisphere(
        context, gpu::kStressIrradiance, "sg times clamped cosine", {1.3e-3, 4e-6},
        reference::kPi64, items,
        [](double lambda, double c) { return reference::sgHemisphere(lambda, c).cosineWeighted; },
        rows);
    stressMeanLength(context, s, rows);
    stressErrorFunction(context, s, rows);
}

} // namespace strandlight
