// What is written to memory and files under stress: RGB9E5, halves, lobes of .sgl files, octahedral
// axes, masks.
#include <bit>

#include <glm/gtc/packing.hpp>

#include "engine/base/error.hpp"
#include "passes/sgl_lobe.hpp"
#include "passes/stress/both.hpp"

namespace strandlight {

namespace {

void stressRgb9e5(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    constexpr std::uint32_t kCombinations = kSpecials * kSpecials * kSpecials;
    const auto items = makeItems(kCombinations + s.items, [&](std::uint32_t i) {
        if (i < kCombinations)
            return gpu::StressInput{
                {specialValue(i, 0), specialValue(i, 1), specialValue(i, 2), 0.0f}, {}, {}, {}};
        StressRandom r(s.seed + 40, i);
        const float scale = r.logUniform(1e-9f, gpu::kRgb9e5Maximum);
        return gpu::StressInput{
            {scale, scale * r.uniform(), scale * r.uniform(), 0.0f}, {}, {}, {}};
    });
    const std::vector<gpu::StressOutput> twin = stressInCpp(gpu::kStressRgb9e5, items);
    Tallies value = tallies("RGB9E5", 1.0, "half a step of the brightest channel");
    onBoth(context, gpu::kStressRgb9e5, items,
           [&](auto m, auto i, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               value[m].require(out.y == twin[i].y, text); // the same word on both machines
               const bool clamps = out.x.w != 0.0f;
               value[m].clamped(clamps ? 1 : 0);
               const double brightest = double(std::max({item.a.x, item.a.y, item.a.z}));
               for (int c = 0; c < 3; ++c) {
                   value[m].bound(double(out.x[c]), 0.0, double(gpu::kRgb9e5Maximum), text);
                   value[m].require(clamps || inRange(item.a[c], 0.0f, gpu::kRgb9e5Maximum), text);
                   if (!clamps) // half a step, which is at least 2^-25
                       value[m].compare(double(out.x[c]), double(item.a[c]),
                                        std::max(brightest / 511.0, std::exp2(-25.0)), text);
               }
           });
    append(rows, value);
}

void stressHalves(std::vector<StressRow>& rows)
{
    Tally bits("fp16, all 65,536 values", 0.0, "the same bits");
    for (std::uint32_t i = 0; i < 65536; ++i) {
        const float value = glm::unpackHalf1x16(std::uint16_t(i));
        const auto text = [&] { return "half " + std::to_string(i); };
        bits.require(std::isnan(value) ? std::isnan(glm::unpackHalf1x16(glm::packHalf1x16(value)))
                                       : glm::packHalf1x16(value) == i,
                     text);
    }
    rows.push_back(bits.row());
}

// A field of lobes whose amplitudes span `decades` around 10^`middle`.
SgField randomField(std::uint32_t seed, std::uint32_t count, float middle)
{
    SgField field;
    field.lobeCount = 1;
    for (std::uint32_t i = 0; i < count; ++i) {
        StressRandom r(seed, i);
        SgLobe lobe;
        lobe.axis = r.direction();
        lobe.logSharpness = r.uniform(-15.0f, 15.0f);
        const float scale = std::pow(10.0f, middle) * r.logUniform(1e-3f, 1.0f);
        lobe.amplitude = scale * glm::vec3(1.0f, r.uniform(), r.uniform());
        field.lobes.push_back(lobe);
    }
    return field;
}

void stressLobeCoding(SglStorage storage, const StressSettings& s, std::vector<StressRow>& rows)
{
    const bool half = storage == SglStorage::Fp16;
    const std::string name = half ? ".sgl fp16" : ".sgl packed";
    // A cell of the octahedral map of 2^16 (2^12) steps is at most 2.9 steps across where it is
    // most stretched.
    Tally axis(name + " axis", half ? 6.5e-5 : 1.04e-3, "radians");
    Tally sharpness(name + " ln sharpness", half ? 0.00391 : 30.0 / 255.0 / 2.0 * 1.001, "1");
    Tally amplitude(name + " amplitude", half ? std::exp2(-11.0) : 1.0 / 511.0,
                    "brightest channel");
    for (int decade = -28; decade <= 34; decade += 2) {
        const SgField field =
            randomField(s.seed + 50 + std::uint32_t(decade + 28), s.items / 16, float(decade));
        const SglLobeCoding coding = chooseCoding(field, storage);
        std::vector<std::uint8_t> bytes(sglBytesPerLobe(storage));
        for (const SgLobe& lobe : field.lobes) {
            const auto text = [&] {
                return "ln sharpness " + std::to_string(lobe.logSharpness) + ", amplitude 10^" +
                       std::to_string(std::log10(lobe.amplitude.x));
            };
            amplitude.clamped(encodeLobe(lobe, coding, bytes) ? 1 : 0);
            const SgLobe back = decodeLobe(bytes, coding);
            axis.compare(double(glm::length(back.axis - lobe.axis)), 0.0, 1.0, text);
            sharpness.compare(double(back.logSharpness), double(lobe.logSharpness), 1.0, text);
            for (int c = 0; c < 3; ++c)
                amplitude.compare(double(back.amplitude[c]), double(lobe.amplitude[c]),
                                  double(lobe.amplitude.x), text);
        }
    }
    for (const Tally* tally : {&axis, &sharpness, &amplitude})
        rows.push_back(tally->row());

    Tally special(name + ", special values", 0.0, "finite, or refused by name");
    for (std::uint32_t i = 0; i < kSpecials * kSpecials * kSpecials * kSpecials; ++i) {
        SgField field;
        field.lobeCount = 1;
        const float z = specialValue(i, 1);
        field.lobes.push_back({glm::vec3(specialValue(i, 0), 0.0f, z), specialValue(i, 2),
                               glm::vec3(specialValue(i, 3), 1.0f, 0.0f)});
        try {
            const SglLobeCoding coding = chooseCoding(field, storage);
            std::vector<std::uint8_t> bytes(sglBytesPerLobe(storage));
            special.clamped(encodeLobe(field.lobes[0], coding, bytes) ? 1 : 0);
            const SgLobe back = decodeLobe(bytes, coding);
            const float sum = back.axis.x + back.axis.y + back.axis.z + back.logSharpness +
                              glm::length(back.amplitude * 1e-20f);
            special.require(std::isfinite(sum), [&] { return "combination " + std::to_string(i); });
        } catch (const Error&) {
            special.refuse();
        }
    }
    rows.push_back(special.row());
}

void stressOctahedral(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(s.items, [&](std::uint32_t i) {
        StressRandom r(s.seed + 60, i);
        glm::vec3 d = r.direction();
        d[int(i % 4) % 3] *= i % 4 == 3 ? 1.0f : r.logUniform(1e-9f, 1.0f); // near the folds
        return gpu::StressInput{glm::vec4(glm::normalize(d), 0.0f), {}, {}, {}};
    });
    Tallies value = tallies("octahedral, there and back", 5e-7, "radians");
    onBoth(context, gpu::kStressOctahedral, items,
           [&](auto m, auto, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               const glm::vec3 d(item.a);
               value[m].compare(double(glm::distance(glm::vec3(out.x), d)), 0.0, 1.0, text);
               value[m].compare(
                   double(glm::distance(glm::vec3(out.y), glm::vec3(d.x, d.y, std::abs(d.z)))), 0.0,
                   1.0, text);
           });
    append(rows, value);
}

void stressMasks(Context& context, const StressSettings& s, std::vector<StressRow>& rows)
{
    const auto items = makeItems(kSpecials + s.items, [&](std::uint32_t i) {
        StressRandom r(s.seed + 61, i);
        const float alpha = i < kSpecials ? specialValue(i, 0) : r.uniform(-0.1f, 1.1f);
        return gpu::StressInput{
            {alpha, float(i), float(s.seed % 4096u), float(i % 640u)}, {}, {}, {}};
    });
    const std::vector<gpu::StressOutput> twin = stressInCpp(gpu::kStressHairMask, items);
    Tallies value = tallies("hair sample masks", 0.0, "4 alpha samples, rounded down or up");
    onBoth(context, gpu::kStressHairMask, items,
           [&](auto m, auto i, const auto& item, const auto& out) {
               const auto text = [&] { return describe(item); };
               value[m].require(out.x == twin[i].x, text);
               const int count = std::popcount(std::uint32_t(out.x.x));
               const float alpha =
                   item.a.x > 0.0f ? std::min(item.a.x, 1.0f) : 0.0f; // NaN: no sample
               value[m].bound(double(count), std::floor(4.0 * double(alpha)),
                              std::ceil(4.0 * double(alpha)), text);
           });
    append(rows, value);
}

} // namespace

std::vector<StressRow> stressStorage(Context& context, const StressSettings& settings)
{
    std::vector<StressRow> rows;
    stressRgb9e5(context, settings, rows);
    stressHalves(rows);
    stressLobeCoding(SglStorage::Fp16, settings, rows);
    stressLobeCoding(SglStorage::Packed, settings, rows);
    stressOctahedral(context, settings, rows);
    stressMasks(context, settings, rows);
    return rows;
}

} // namespace strandlight
