// Spherical gaussians under stress: value, integral, product, inner product, hemispheres, mean
// length, axes.
#include "passes/stress/both.hpp"
#include "passes/stress/lobe_integrals.hpp"
#include "passes/stress/reference.hpp"

namespace strandlight {

namespace {

constexpr double kEnergy = 4.0 * reference::kPi64;
constexpr float kSharpest = gpu::kSgMaxSharpness;
const glm::vec3 kUp(0.0f, 0.0f, 1.0f);

void stressValue(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    // To eight standard deviations: beyond, a lobe is nothing.
    const auto items = makeItems(s.items, [&](std::uint32_t i) {
        StressRandom r(s.seed, i);
        const float lambda = r.logUniform(1e-6f, 1e6f);
        const glm::vec3 axis = r.direction();
        const float angle = std::min(r.uniform(0.0f, 8.0f) / std::sqrt(lambda), 3.14159f);
        return gpu::StressInput{
            glm::vec4(r.near(axis, angle), lambda), glm::vec4(axis, 0.0f), {}, {}};
    });
    Tallies value = tallies("sg value", 2e-5, "value");
    onBoth(context, gpu::kStressEvaluate, items,
           [&](auto m, auto, const auto& item, const auto& out) {
               const double expected = std::exp(
                   reference::sgLogValue(glm::vec3(item.a), glm::vec3(item.b), double(item.a.w)));
               const auto text = [&] { return describe(item); };
               value[m].compare(double(out.x.x), expected, std::max(expected, 1e-30), text);
               value[m].bound(double(out.x.x), 0.0, 1.0 + 1e-6, text);
           });
    append(rows, value);

    // Every axis of special values, made unit as the decoder does, against every special sharpness.
    const auto special =
        makeItems(kSpecials * kSpecials * kSpecials * kSpecials, [](std::uint32_t i) {
            const glm::vec3 raw(specialValue(i, 0), specialValue(i, 1), specialValue(i, 2));
            return gpu::StressInput{glm::vec4(kUp, specialValue(i, 3)),
                                    glm::vec4(gpu::safeNormalize(raw, kUp), 0.0f),
                                    {},
                                    {}};
        });
    Tallies bounds = tallies("sg value, special values", 0.0, "in [0, 1]");
    onBoth(context, gpu::kStressEvaluate, special,
           [&](auto m, auto, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               if (std::isfinite(item.a.w) &&
                   std::isfinite(item.b.x)) // any finite sharpness, however large
                   bounds[m].bound(double(out.x.x), 0.0, 1.0 + 1e-6, text);
               else
                   bounds[m].refuse(double(out.x.x), 0.0, 1.0 + 1e-6, text);
           });
    append(rows, bounds);
}

void stressIntegral(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items + kSpecials, [&](std::uint32_t i) {
        StressRandom r(s.seed + 1, i);
        const float lambda = i < kSpecials ? specialValue(i, 0) : r.logUniform(1e-38f, 1e6f);
        return gpu::StressInput{glm::vec4(kUp, lambda), {}, {}, {}};
    });
    Tallies value = tallies("sg integral", 1e-6, "value");
    onBoth(context, gpu::kStressIntegral, items,
           [&](auto m, auto, const auto& item, const auto& out) {
               const double lambda = double(item.a.w);
               const auto text = [&] { return describe(item); };
               if (!std::isfinite(lambda) || lambda < 0.0)
                   return value[m].refuse(double(out.x.x), 0.0, kEnergy * (1.0 + 1e-6), text);
               const double expected = reference::sgIntegral(lambda);
               value[m].compare(double(out.x.x), expected, std::max(expected, 1e-30), text);
           });
    append(rows, value);
}

// Equal, nearly equal, opposed, nearly opposed, and any axes.
gpu::StressInput lobePair(std::uint32_t seed, std::uint32_t i)
{
    StressRandom r(seed, i);
    const float lambda1 = r.logUniform(1e-6f, kSharpest);
    const float lambda2 = i % 3 == 0 ? lambda1 : r.logUniform(1e-6f, kSharpest);
    const glm::vec3 axis1 = r.direction();
    const float angle = r.logUniform(1e-7f, 3.0f);
    glm::vec3 axis2 = i % 7 == 0 ? axis1 : r.near(axis1, angle);
    if (i % 2 == 0)
        axis2 = -axis2;
    return {glm::vec4(axis1, lambda1), glm::vec4(axis2, lambda2), {}, {}};
}

void stressProduct(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items, [&](std::uint32_t i) { return lobePair(s.seed + 2, i); });
    // ln amplitudes down to -69 are looked at, and an exponent of 69 is rounded by 4e-6 a few
    // times.
    Tallies point = tallies("sg product, pointwise", 4e-5, "peak of the product");
    Tallies inner = tallies("sg inner product", 1e-4, "value");
    onBoth(context, gpu::kStressProduct, items,
           [&](auto m, auto i, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               const glm::dvec3 axis1(item.a), axis2(item.b);
               const double lambda1 = double(item.a.w), lambda2 = double(item.b.w);
               // Compared up to three standard deviations of the product from its axis.
               StressRandom r(s.seed + 3, std::uint32_t(i));
               const float spread = 3.0f * r.uniform() / std::sqrt(std::max(out.x.w, 1e-3f));
               const glm::dvec3 d(r.near(glm::normalize(glm::vec3(out.x)), std::min(spread, 3.1f)));
               const double expected = reference::sgLogValue(d, axis1, lambda1) +
                                       reference::sgLogValue(d, axis2, lambda2);
               const double value =
                   double(out.y.x) + reference::sgLogValue(d, glm::dvec3(out.x), double(out.x.w));
               const double peak = reference::sgLogInnerProduct(axis1, lambda1, axis2, lambda2) -
                                   std::log(reference::sgIntegral(double(out.x.w)));
               point[m].compare(std::exp(value), std::exp(expected),
                                std::max(std::exp(peak), 1e-30), text);
               const double integral =
                   std::exp(reference::sgLogInnerProduct(axis1, lambda1, axis2, lambda2));
               inner[m].compare(double(out.y.y), integral, std::max(integral, 1e-30), text);
           });
    append(rows, point);
    append(rows, inner);

    const auto special =
        makeItems(kSpecials * kSpecials * kSpecials * kSpecials, [](std::uint32_t i) {
            const glm::vec3 raw(specialValue(i, 0), 0.0f, specialValue(i, 1));
            return gpu::StressInput{glm::vec4(kUp, specialValue(i, 2)),
                                    glm::vec4(gpu::safeNormalize(-raw, kUp), specialValue(i, 3)),
                                    {},
                                    {}};
        });
    Tallies bounds = tallies("sg product, special values", 0.0, "in [0, 4 pi]");
    onBoth(context, gpu::kStressProduct, special,
           [&](auto m, auto, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               const double high = kEnergy * (1.0 + 1e-6), integral = double(out.y.y);
               if (!inRange(item.a.w, 0.0f, kSharpest) || !inRange(item.b.w, 0.0f, kSharpest) ||
                   !std::isfinite(item.b.x))
                   return bounds[m].refuse(integral, 0.0, high, text);
               bounds[m].bound(integral, 0.0, high, text);
               bounds[m].bound(double(glm::length(glm::vec3(out.x))), 1.0 - 1e-6, 1.0 + 1e-6, text);
               bounds[m].bound(double(out.x.w), 0.0, 2.0 * double(kSharpest) * (1.0 + 1e-6), text);
               bounds[m].bound(double(out.y.x), -2.0 * double(kSharpest), 0.0, text);
           });
    append(rows, bounds);
}

void stressAxes(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    constexpr std::uint32_t kCombinations = kSpecials * kSpecials * kSpecials;
    const auto items = makeItems(kCombinations + s.items, [&](std::uint32_t i) {
        if (i < kCombinations)
            return gpu::StressInput{
                {specialValue(i, 0), -specialValue(i, 1), specialValue(i, 2), 0.0f}, {}, {}, {}};
        StressRandom r(s.seed + 4, i);
        return gpu::StressInput{
            glm::vec4(r.direction() * r.logUniform(1e-30f, 1e38f), 0.0f), {}, {}, {}};
    });
    Tallies axis = tallies("axis normalisation", 4e-7, "1");
    onBoth(context, gpu::kStressNormalize, items,
           [&](auto m, auto, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               if (glm::any(glm::isnan(item.a)))
                   return axis[m].require(std::isnan(out.x.x), text); // shows
               const glm::dvec3 raw(item.a);
               const double length = glm::length(raw);
               // Below 1e-30, by the sum of the components, a vector has no direction.
               const double error =
                   length < 1e-30 || !std::isfinite(length) || length > 3e38
                       ? glm::length(glm::dvec3(out.x)) - 1.0 // the fallback: any unit vector
                       : glm::length(glm::dvec3(out.x) - raw / length);
               axis[m].compare(error, 0.0, 1.0, text);
           });
    append(rows, axis);
}

} // namespace

std::vector<StressRow> stressLobes(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    stressValue(context, settings, rows);
    stressIntegral(context, settings, rows);
    stressProduct(context, settings, rows);
    stressAxes(context, settings, rows);
    stressLobeIntegrals(context, settings, rows);
    return rows;
}

} // namespace strandlight
