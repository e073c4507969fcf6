#include "passes/hair_training_batch.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "engine/base/assert.hpp"
#include "shaders/shared/hair_types.h"
#include "shaders/shared/rng.h"

namespace strandlight {
namespace {

constexpr std::uint32_t kCropDimension = 0x63726f70u; // apart from other uses of the same seed
constexpr std::uint32_t kTries = 6;                   // for a crop with hair in its middle
constexpr float kMostStops = 1.5f;                    // of the exposure's augmentation
constexpr std::uint32_t kInputPlanes = gpu::kHairInputPlanes;

// A table: the frames are unpacked again at every step. A value that is not finite (radiance that
// was extrapolated from a sliver's pixel outside of it) counts as no light.
const std::vector<float>& halfValues()
{
    static const std::vector<float> values = [] {
        std::vector<float> table(65536);
        for (std::uint32_t i = 0; i < table.size(); ++i)
            table[i] = (i & 0x7c00u) == 0x7c00u ? 0.0f : glm::unpackHalf1x16(std::uint16_t(i));
        return table;
    }();
    return values;
}

// What the picture's symmetry makes of a value of plane kind 0 to 5 (kHairInputPlanes). The tangent
// is (cos 2a, sin 2a): a flip turns a into pi - a or -a, a transposition into pi/2 - a.
float turned(std::uint32_t kind, float value, const HairAugmentation& how)
{
    if (kind == 0)
        return how.exposure == 1.0f ? std::max(value, 0.0f)
                                    : std::log1p(how.exposure * std::expm1(std::max(value, 0.0f)));
    const bool negated = (kind == 4 && how.transpose) || (kind == 5 && how.flipX != how.flipY);
    return negated ? -value : value;
}

// Reads planes of a frame where a turned crop's pixels come from.
class CropReader
{
public:
    CropReader(const HairTrainingFrame& frame, std::uint32_t size, glm::uvec2 corner,
               const HairAugmentation& how)
        : frame_(frame), offsets_(std::size_t(size) * size)
    {
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x) {
                glm::uvec2 from(how.flipX ? size - 1 - x : x, how.flipY ? size - 1 - y : y);
                if (how.transpose)
                    std::swap(from.x, from.y);
                from += corner;
                offsets_[std::size_t(y) * size + x] = from.y * frame.size + from.x;
            }
    }

    template <class Map> void read(std::size_t plane, float* to, const Map& map) const
    {
        const std::uint16_t* from = frame_.planes.data() + plane * frame_.size * frame_.size;
        const float* values = halfValues().data();
        for (std::size_t i = 0; i < offsets_.size(); ++i)
            to[i] = map(values[from[offsets_[i]]]);
    }

private:
    const HairTrainingFrame& frame_;
    std::vector<std::uint32_t> offsets_; // in a plane
};

HairAugmentation drawAugmentation(glm::vec3 u, glm::vec3 v)
{
    HairAugmentation how;
    const auto symmetry = std::uint32_t(u.x * 8.0f);
    how.transpose = (symmetry & 1u) != 0;
    how.flipX = (symmetry & 2u) != 0;
    how.flipY = (symmetry & 4u) != 0;
    auto order = std::uint32_t(u.y * 24.0f);
    for (std::uint32_t left = 4; left > 1; order /= left, --left)
        std::swap(how.samples[left - 1], how.samples[order % left]);
    how.exposure = std::exp2(kMostStops * (2.0f * v.x - 1.0f));
    return how;
}

} // namespace

HairBatch makeHairBatch(std::uint32_t n, std::uint32_t size)
{
    const std::size_t pixels = std::size_t(n) * size * size;
    HairBatch batch{n, size, {}, {}, {}, {}};
    batch.input.resize(pixels * kInputPlanes);
    batch.target.resize(pixels * kHairOutputs);
    batch.image.resize(pixels * 4);
    batch.truth.resize(pixels * 4);
    return batch;
}

void fillHairCrop(HairBatch& batch, std::uint32_t slot, const HairTrainingFrame& frame,
                  std::uint32_t repeat, glm::uvec2 corner, const HairAugmentation& how)
{
    STRANDLIGHT_ASSERT(slot < batch.n && repeat < frame.repeats);
    STRANDLIGHT_ASSERT(std::max(corner.x, corner.y) + batch.size <= frame.size);
    const CropReader crop(frame, batch.size, corner, how);
    const std::size_t pixels = std::size_t(batch.size) * batch.size;
    const std::size_t first = frame.repeatPlane(repeat);
    const std::size_t truth = frame.targetPlane();
    const auto same = [](float value) { return value; };
    const auto exposed = [&](float value) { return how.exposure * std::max(value, 0.0f); };

    float* input = batch.input.data() + slot * kInputPlanes * pixels;
    for (std::uint32_t kind = 0; kind < 6; ++kind)
        for (std::uint32_t s = 0; s < 4; ++s)
            crop.read(first + 4 * kind + how.samples[s], input + (4 * kind + s) * pixels,
                      [&](float value) { return turned(kind, value, how); });
    float* exact = input + gpu::kHairInputExact * pixels;
    crop.read(first + gpu::kHairInputExact, exact, same);
    float* blended = input + gpu::kHairInputBlended * pixels;
    crop.read(first + gpu::kHairInputBlended, blended,
              [&](float value) { return turned(0, value, how); });

    float* image = batch.image.data() + slot * 4 * pixels;
    float* radiance = batch.truth.data() + slot * 4 * pixels;
    for (std::uint32_t c = 0; c < 3; ++c) {
        crop.read(first + kHairBlendedPlane + c, image + c * pixels, exposed);
        crop.read(truth + c, radiance + c * pixels, exposed);
    }
    float* target = batch.target.data() + slot * kHairOutputs * pixels;
    crop.read(truth + 4, target + pixels, same);
    crop.read(truth + 3, target + 2 * pixels, same);
    for (std::size_t i = 0; i < pixels; ++i) {
        target[i] = std::log1p(0.2126f * radiance[i] + 0.7152f * radiance[pixels + i] +
                               0.0722f * radiance[2 * pixels + i]) -
                    blended[i];
        target[2 * pixels + i] -= exact[i];
    }
}

HairBatch drawHairBatch(std::span<const HairTrainingFrame> frames, std::uint32_t n,
                        std::uint32_t size, std::uint32_t seed, std::uint32_t step)
{
    HairBatch batch = makeHairBatch(n, size);
    for (std::uint32_t slot = 0; slot < n; ++slot) {
        std::uint32_t next = kCropDimension;
        const auto draw = [&] { return gpu::uniform3(step, slot, next++, seed); };
        const glm::vec3 u = draw();
        const HairTrainingFrame& frame =
            frames[std::min(std::size_t(u.x * float(frames.size())), frames.size() - 1)];
        const auto repeat = std::uint32_t(u.y * float(frame.repeats));
        const HairAugmentation how = drawAugmentation(draw(), draw());
        const float places = float(frame.size - size + 1);
        glm::uvec2 corner(0);
        for (std::uint32_t attempt = 0; attempt < kTries; ++attempt) {
            const glm::vec3 place = draw();
            corner = glm::uvec2(std::uint32_t(place.x * places), std::uint32_t(place.y * places));
            const glm::uvec2 middle = corner + size / 2;
            if (frame.at(frame.repeatPlane(repeat) + gpu::kHairInputExact, middle.x, middle.y) <
                0.99f)
                break;
        }
        fillHairCrop(batch, slot, frame, repeat, corner, how);
    }
    return batch;
}

} // namespace strandlight
