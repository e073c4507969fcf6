// Reflection of lobes, the surface BRDF and the hair fibre under stress.
#include "passes/stress/both.hpp"

namespace strandlight {

namespace {

constexpr float kSharpest = gpu::kSgMaxSharpness;
const glm::vec3 kUp(0.0f, 0.0f, 1.0f);

// A unit direction above the horizon, often at grazing angles.
glm::vec3 viewAbove(StressRandom& r)
{
    const float z = r.uniform() < 0.5f ? r.uniform(0.0f, 1.0f) : r.logUniform(1e-5f, 1.0f);
    const float turn = r.uniform(0.0f, 6.2831853f), side = std::sqrt((1.0f - z) * (1.0f + z));
    return glm::normalize(glm::vec3(side * std::cos(turn), side * std::sin(turn), z));
}

// Where a lobe is brightest is what its rounding is measured by: far out on its flank the value is
// nothing, and relative errors there only repeat the rounding of its axis.
double brightest(std::uint32_t function, gpu::StressInput item)
{
    const glm::vec3 view(item.a);
    const glm::vec3 peak = function == gpu::kStressMixture ? glm::vec3(item.c.x, 0.0f, item.c.y)
                                                           : kUp * (2.0f * view.z) - view;
    const double here = stressInDouble(function, item).x.x;
    item.b = glm::vec4(peak, item.b.w);
    return std::max({here, 1e-2 * stressInDouble(function, item).x.x, 1e-30});
}

void stressSpecular(Context& context, std::uint32_t function, const std::string& name,
                    double tolerance, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items, [&](std::uint32_t i) {
        StressRandom r(s.seed + 20 + function, i);
        const glm::vec3 view = viewAbove(r), mirror = kUp * (2.0f * view.z) - view;
        const float alpha = r.logUniform(0.02f, 1.0f), lambda = r.logUniform(1e-3f, kSharpest);
        const float spread = std::min(3.0f * std::hypot(alpha, 1.0f / std::sqrt(lambda)), 3.1f);
        const glm::vec3 axis = i % 4 ? r.near(mirror, spread * r.uniform()) : r.direction();
        const float tilt = r.uniform(-1.5f, 1.5f);
        return gpu::StressInput{glm::vec4(view, lambda),
                                glm::vec4(axis, alpha),
                                {std::sin(tilt), std::cos(tilt), r.logUniform(1e-2f, 1e4f), 1.0f},
                                {0.9f, 0.1f, 0.0f, 0.0f}};
    });
    std::vector<double> scales;
    for (const gpu::StressInput& item : items)
        scales.push_back(brightest(function, item));
    Tallies value = tallies(name, tolerance, "value, or 1 % of the peak");
    onBoth(context, function, items, [&](auto m, auto i, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        value[m].compare(double(out.x.x), stressInDouble(function, item).x.x, scales[i], text);
        value[m].bound(double(out.x.x), 0.0, 1e30, text);
        value[m].bound(double(out.x.y), 0.0, 1e30, text);
    });
    append(rows, value);

    const auto special =
        makeItems(kSpecials * kSpecials * kSpecials * kSpecials, [](std::uint32_t i) {
            const glm::vec3 view = gpu::safeNormalize({1.0f, 0.0f, specialValue(i, 0)}, kUp);
            const glm::vec3 axis = gpu::safeNormalize({-1.0f, 0.0f, specialValue(i, 1)}, kUp);
            return gpu::StressInput{glm::vec4(view, specialValue(i, 2)),
                                    glm::vec4(axis, specialValue(i, 3)),
                                    {0.6f, 0.8f, 1e4f, 1.0f},
                                    {0.9f, 0.1f, 0.0f, 0.0f}};
        });
    Tallies bounds = tallies(name + ", special values", 0.0, "finite, not negative");
    onBoth(context, function, special, [&](auto m, auto, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        if (inRange(item.a.w, 0.0f, kSharpest) && inRange(item.b.w, 0.0f, 1.0f) &&
            item.a.z >= 0.0f && std::isfinite(item.b.x))
            bounds[m].bound(double(out.x.x), 0.0, 1e30, text);
        else
            bounds[m].refuse();
    });
    append(rows, bounds);
}

void stressBrdf(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items, [&](std::uint32_t i) {
        StressRandom r(s.seed + 30, i);
        const glm::vec3 view = viewAbove(r), mirror = kUp * (2.0f * view.z) - view;
        const float roughness = i % 5 == 0 ? 0.0f : r.uniform();
        const glm::vec3 light = i % 3 ? r.near(mirror, r.logUniform(1e-4f, 1.0f)) : r.direction();
        return gpu::StressInput{glm::vec4(view, roughness),
                                glm::vec4(light, 1.0f),
                                {r.uniform(), 0.5f, 1.0f, i % 2 ? 1.0f : 0.0f},
                                {}};
    });
    Tallies value = tallies("surface BRDF", 1e-4, "value");
    Tallies density = tallies("density of its sampling", 1e-4, "value");
    onBoth(context, gpu::kStressBrdf, items, [&](auto m, auto, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        const StressOutputDouble expected = stressInDouble(gpu::kStressBrdf, item);
        for (int c = 0; c < 3; ++c)
            value[m].compare(double(out.x[c]), expected.x[c], std::max(expected.x[c], 1e-3), text);
        density[m].compare(double(out.x.w), expected.x.w, std::max(expected.x.w, 1e-3), text);
    });
    append(rows, value);
    append(rows, density);
}

gpu::StressInput fibre(std::uint32_t seed, std::uint32_t i)
{
    StressRandom r(seed, i);
    const glm::vec3 tangent = r.direction();
    // Light and view anywhere, and close to the fibre's own direction.
    const auto about = [&](std::uint32_t choice) {
        return choice % 3 ? r.direction()
                          : r.near(choice % 2 ? tangent : -tangent, r.logUniform(1e-6f, 0.3f));
    };
    const glm::vec3 light = about(i), view = about(i / 3);
    const float color = i % 5 == 0 ? 0.0f : r.logUniform(1e-6f, 1.0f);
    return {glm::vec4(tangent, r.uniform()),
            glm::vec4(light, r.uniform(-0.1f, 0.1f)),
            glm::vec4(view, r.uniform()),
            {color, r.uniform(), 1.0f, 0.0f}};
}

// The density peaks at 1 / variance along the fibre: 0.73 / (0.25 x 1.5e-3) for TT at the smallest
// roughness.
constexpr double kBrightestFibre = 1e4;

void stressHair(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items, [&](std::uint32_t i) { return fibre(s.seed + 31, i); });
    Tallies once = tallies("hair fibre", 2e-4, "value, or 1e-2");
    Tallies often = tallies("hair, multiple scattering", 1e-4, "value, or 1e-3");
    onBoth(context, gpu::kStressHair, items, [&](auto m, auto, const auto& item, const auto& out) {
        const auto text = [&] { return describe(item); };
        const StressOutputDouble expected = stressInDouble(gpu::kStressHair, item);
        for (int c = 0; c < 3; ++c) {
            once[m].compare(double(out.x[c]), expected.x[c], std::max(expected.x[c], 1e-2), text);
            once[m].bound(double(out.x[c]), 0.0, kBrightestFibre, text);
            often[m].compare(double(out.y[c]), expected.y[c], std::max(expected.y[c], 1e-3), text);
        }
    });
    append(rows, once);
    append(rows, often);

    const auto special =
        makeItems(kSpecials * kSpecials * kSpecials * kSpecials, [](std::uint32_t i) {
            const glm::vec3 tangent = gpu::safeNormalize({1.0f, 0.0f, specialValue(i, 0)}, kUp);
            const glm::vec3 light = gpu::safeNormalize({1.0f, 0.0f, specialValue(i, 1)}, kUp);
            const float color = specialValue(i, 3);
            return gpu::StressInput{glm::vec4(tangent, specialValue(i, 2)), glm::vec4(light, 0.03f),
                                    glm::vec4(1.0f, 0.0f, 0.0f, 0.5f), glm::vec4(color)};
        });
    Tallies bounds = tallies("hair, special values", 0.0, "in [0, 1e4]");
    onBoth(context, gpu::kStressHair, special,
           [&](auto m, auto, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               if (!inRange(item.a.w, 0.0f, 1.0f) || !inRange(item.d.x, 0.0f, 1.0f) ||
                   !std::isfinite(item.a.x) || !std::isfinite(item.b.x))
                   return bounds[m].refuse();
               bounds[m].bound(double(out.x.x), 0.0, kBrightestFibre, text);
               bounds[m].bound(double(out.y.x), 0.0, 1.0, text);
           });
    append(rows, bounds);
}

} // namespace

std::vector<StressRow> stressScattering(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    stressSpecular(context, gpu::kStressMixture, "glossy, mixture", 5e-4, settings, rows);
    // At grazing views the half vector is the small sum of nearly opposed directions.
    stressSpecular(context, gpu::kStressNdf, "glossy, NDF filter", 5e-3, settings, rows);
    stressSpecular(context, gpu::kStressAsg, "glossy, ASG", 5e-4, settings, rows);
    stressBrdf(context, settings, rows);
    stressHair(context, settings, rows);
    return rows;
}

} // namespace strandlight
