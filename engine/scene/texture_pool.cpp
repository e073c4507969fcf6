#include "engine/scene/texture_pool.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/error.hpp"
#include "engine/base/image_io.hpp"
#include "engine/base/log.hpp"

namespace strandlight {

namespace {

// One level of one texture: linear values while it is filtered. [height, width]
struct Level
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec4> texels;
};

// One reading of a texture: which one, whether its colours are sRGB coded, and the first level
// kept.
struct Reading
{
    std::uint32_t texture = 0;
    bool srgb = false;
    std::uint32_t skippedLevels = 0;
};

float decode(std::uint8_t value, bool srgb)
{
    const float coded = float(value) / 255.0f;
    return srgb ? decodeSrgb(coded) : coded;
}

std::uint32_t encode(float value, bool srgb)
{
    const float clamped = std::min(std::max(value, 0.0f), 1.0f);
    return static_cast<std::uint32_t>((srgb ? encodeSrgb(clamped) : clamped) * 255.0f + 0.5f);
}

Level decodeLevel(const Texture& texture, bool srgb)
{
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = decode(static_cast<std::uint8_t>(i), srgb);
    Level level{texture.width, texture.height, {}};
    level.texels.resize(std::size_t(texture.width) * texture.height);
    for (std::size_t i = 0; i < level.texels.size(); ++i) {
        const std::uint8_t* p = texture.rgba.data() + 4 * i;
        level.texels[i] = glm::vec4(table[p[0]], table[p[1]], table[p[2]], float(p[3]) / 255.0f);
    }
    return level;
}

// Box filter. An odd side loses its last column or row to its neighbour: three texels make the last
// one.
Level halve(const Level& fine)
{
    Level coarse{std::max(fine.width / 2, 1u), std::max(fine.height / 2, 1u), {}};
    coarse.texels.reserve(std::size_t(coarse.width) * coarse.height);
    const auto span = [](std::uint32_t i, std::uint32_t coarseSide, std::uint32_t fineSide) {
        return i + 1 == coarseSide ? fineSide : std::min(2 * i + 2, fineSide);
    };
    for (std::uint32_t y = 0; y < coarse.height; ++y) {
        for (std::uint32_t x = 0; x < coarse.width; ++x) {
            glm::vec4 sum(0.0f);
            float count = 0.0f;
            for (std::uint32_t fy = 2 * y; fy < span(y, coarse.height, fine.height); ++fy) {
                for (std::uint32_t fx = 2 * x; fx < span(x, coarse.width, fine.width); ++fx) {
                    sum += fine.texels[std::size_t(fy) * fine.width + fx];
                    count += 1.0f;
                }
            }
            coarse.texels.push_back(sum / count);
        }
    }
    return coarse;
}

std::uint32_t levelCount(std::uint32_t width, std::uint32_t height)
{
    std::uint32_t levels = 1;
    for (std::uint32_t side = std::max(width, height); side > 1; side /= 2)
        ++levels;
    return levels;
}

// Words of a full chain whose finest level is `skipped` halvings down.
std::uint64_t chainWords(const Texture& texture, std::uint32_t skipped)
{
    std::uint64_t words = 0;
    const std::uint32_t levels = levelCount(texture.width, texture.height);
    for (std::uint32_t level = skipped; level < levels; ++level)
        words += std::uint64_t(std::max(texture.width >> level, 1u)) *
                 std::max(texture.height >> level, 1u);
    return words;
}

std::vector<Reading> usedReadings(const Scene& scene)
{
    std::vector<bool> used(2 * scene.textures.size(), false);
    const auto use = [&](const TextureSlot& slot, std::size_t srgb) {
        if (slot.texture >= 0)
            used[2 * std::size_t(slot.texture) + srgb] = true;
    };
    for (const Material& material : scene.materials) {
        use(material.baseColorTexture, 1);
        use(material.metallicRoughnessTexture, 0);
        use(material.normalTexture, 0);
        use(material.emissiveTexture, 1);
    }
    std::vector<Reading> readings;
    for (std::uint32_t i = 0; i < used.size(); ++i) {
        if (used[i])
            readings.push_back({i / 2, i % 2 == 1, 0});
    }
    return readings;
}

// Halves the largest chain until all fit. Ties go to the first, so the result is always the same.
std::uint32_t fitReadings(const Scene& scene, std::vector<Reading>& readings,
                          std::uint64_t recordWords, std::uint64_t maximumBytes)
{
    std::uint32_t halvings = 0;
    for (;;) {
        std::uint64_t total = recordWords;
        std::uint64_t largest = 0;
        Reading* victim = nullptr;
        for (Reading& reading : readings) {
            const std::uint64_t words =
                chainWords(scene.textures[reading.texture], reading.skippedLevels);
            total += words;
            if (words > largest) {
                largest = words;
                victim = &reading;
            }
        }
        if (total * 4 <= maximumBytes)
            return halvings;
        if (largest <= 1)
            throw Error("the scene's " + std::to_string(readings.size()) + " textures do not fit " +
                        std::to_string(maximumBytes) + " bytes even at one texel each");
        ++victim->skippedLevels;
        ++halvings;
    }
}

void appendReading(const Scene& scene, const Reading& reading, std::vector<std::uint32_t>& words)
{
    const Texture& texture = scene.textures[reading.texture];
    Level level = decodeLevel(texture, reading.srgb);
    for (std::uint32_t i = 0; i < reading.skippedLevels; ++i)
        level = halve(level);
    const std::uint32_t levels = levelCount(level.width, level.height);
    const std::size_t record =
        std::size_t(2 * reading.texture + (reading.srgb ? 1 : 0)) * gpu::kTextureRecordWords;
    words[record] = level.width | level.height << 16;
    words[record + 1] = levels | std::uint32_t(texture.wrapU) << 8 |
                        std::uint32_t(texture.wrapV) << 10 | (reading.srgb ? 0x1000u : 0u);
    for (std::uint32_t i = 0; i < levels; ++i) {
        words[record + 3 + i] = static_cast<std::uint32_t>(words.size());
        for (const glm::vec4& t : level.texels)
            words.push_back(encode(t.x, reading.srgb) | encode(t.y, reading.srgb) << 8 |
                            encode(t.z, reading.srgb) << 16 | encode(t.w, false) << 24);
        if (i + 1 < levels)
            level = halve(level);
    }
}

} // namespace

TexturePool packTextures(const Scene& scene, std::uint64_t maximumBytes)
{
    TexturePool pool;
    std::vector<Reading> readings = usedReadings(scene);
    if (readings.empty())
        return pool;
    const std::uint64_t recordWords = 2 * scene.textures.size() * gpu::kTextureRecordWords;
    pool.halvings = fitReadings(scene, readings, recordWords, maximumBytes);
    if (pool.halvings > 0)
        logWarning("textures halved " + std::to_string(pool.halvings) + " times in all to fit " +
                   std::to_string(maximumBytes >> 20) + " MiB");
    pool.words.resize(recordWords);
    for (const Reading& reading : readings)
        appendReading(scene, reading, pool.words);
    return pool;
}

} // namespace strandlight
