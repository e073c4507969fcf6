// Bakes for the tests of .sgl files, and what a hostile writer would do to one.
#pragma once

#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/scene/scene_loader.hpp"
#include "passes/sgl_file.hpp"
#include "shaders/shared/rng.h"

namespace strandlight::test {

// Amplitudes over eight decades, sharpness from 0.1 to 10^4, axes over the upper hemisphere.
inline SgField makeField(std::size_t texels, std::uint32_t lobeCount, std::uint32_t seed)
{
    SgField field;
    field.lobeCount = lobeCount;
    for (std::uint32_t i = 0; i < texels * lobeCount; ++i) {
        const glm::vec3 a = gpu::uniform3(i, 0, 0, seed);
        const glm::vec3 b = gpu::uniform3(i, 1, 0, seed);
        const float z = a.x;
        const float r = std::sqrt(1.0f - z * z);
        SgLobe lobe;
        lobe.axis = {r * std::cos(6.2831853f * a.y), r * std::sin(6.2831853f * a.y), z};
        lobe.logSharpness = std::log(0.1f) + a.z * std::log(1e5f);
        lobe.amplitude = glm::vec3(b.x, b.y, 0.3f) * std::pow(10.0f, 8.0f * b.z - 4.0f);
        field.lobes.push_back(lobe);
    }
    return field;
}

inline SgBake makeBake(std::uint32_t resolution, bool withEnvironment)
{
    SgBake bake;
    bake.info = {.scene = "builtin:room",
                 .fitMode = "direct",
                 .geometryHash = 0x123456789ABCDEFull,
                 .environmentHash = 42,
                 .lightfieldSize = 16,
                 .samplesPerDirection = 4,
                 .bounces = 6,
                 .steps = 600,
                 .seed = 7,
                 .rmse = 0.25f};
    bake.atlas = buildAtlas(loadScene("builtin:furnace"), {.resolution = resolution, .gutter = 2});
    bake.radiance = makeField(bake.atlas.texels.size(), 3, 1);
    if (withEnvironment)
        bake.environment = makeField(bake.atlas.texels.size(), 2, 2);
    return bake;
}

// Tiles of 4 x 4 texels that keep lobes by chance, some none, some all.
inline SgBake makeTiledBake(std::uint32_t resolution)
{
    SgBake bake = makeBake(resolution, true);
    bake.radiance = makeField(bake.atlas.texels.size(), 11, 3); // two bytes a mask
    bake.radiance.tileSize = 4;
    const LobeTiles tiles = lobeTiles(bake.atlas, 4);
    for (const std::uint32_t tile : tiles.tileOf) {
        const std::uint32_t mask = gpu::hashPcg(tile) & bake.radiance.allLobes();
        bake.radiance.kept.push_back(tile % 5 == 0 ? 0u : tile % 5 == 1 ? 0x7ffu : mask);
    }
    return bake;
}

inline std::string errorOf(std::span<const std::uint8_t> bytes)
{
    try {
        decodeSgl(bytes, "test.sgl");
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

// Makes the checksums right again after a change, as a hostile writer would.
inline void repairChecksums(std::vector<std::uint8_t>& bytes)
{
    const auto put = [&](std::size_t at, std::uint32_t value) {
        std::memcpy(&bytes[at], &value, 4);
    };
    const std::size_t chunkCount = bytes[24];
    std::size_t offset = 32 + 24 * chunkCount;
    for (std::size_t i = 0; i < chunkCount; ++i) {
        std::uint64_t size = 0;
        std::memcpy(&size, &bytes[32 + 24 * i + 16], 8);
        put(32 + 24 * i + 4, crc32(std::span(std::as_const(bytes)).subspan(offset, size)));
        offset += size;
    }
    put(28, 0);
    put(28, crc32(std::span(std::as_const(bytes)).first(32 + 24 * chunkCount)));
}

} // namespace strandlight::test
