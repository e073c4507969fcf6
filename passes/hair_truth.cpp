#include "passes/hair_truth.hpp"

#include <cstdio>
#include <optional>
#include <string>

#include "engine/base/byte_stream.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/fnv1a.hpp"
#include "engine/base/kernel_blob.hpp"
#include "engine/base/log.hpp"
#include "kernels/hair.gen.hpp"
#include "passes/bake_identity.hpp"

namespace strandlight {
namespace {

constexpr std::uint32_t kMagic = 0x54484C53u; // "SLHT"
constexpr std::uint32_t kVersion = 1;         // another when host code changes what is drawn

template <class T> void hashArray(Fnv1a& hash, const std::vector<T>& values)
{
    hash.value(std::uint64_t(values.size()));
    hash.bytes(values.data(), values.size() * sizeof(T));
}

void hashSettings(Fnv1a& hash, const HairRenderSettings& s)
{
    for (const std::uint32_t v :
         {s.width, s.height, s.frames, s.frameIndex, s.lod, std::uint32_t(s.shadows), s.shadowSize})
        hash.value(v);
    for (const float v : {s.alpha, s.roughness, s.tiltDegrees})
        hash.value(v);
    hash.value(s.lensShift);
    for (const glm::vec3& v : {s.ambient, s.keyDirection, s.keyIrradiance, s.backgroundColor})
        hash.value(v);
}

// Of everything that a truth depends on.
std::uint64_t identity(const Context& context, const HairStrands& hair, const Scene* opaque,
                       const Camera& camera, const HairRenderSettings& settings)
{
    Fnv1a hash;
    hash.value(kVersion);
    const std::string device = context.device().name + "\n" + context.device().driver;
    hash.bytes(device.data(), device.size());
    for (const KernelBlob* kernel :
         {&kernels::hair_strands_vert, &kernels::hair_color_frag, &kernels::hair_silhouette_vert,
          &kernels::hair_shadow_frag, &kernels::hair_opaque_vert, &kernels::hair_opaque_frag,
          &kernels::hair_depth_frag, &kernels::hair_surface_shadow, &kernels::hair_shade,
          &kernels::hair_shade_shadowed, &kernels::hair_resolve})
        hash.bytes(kernel->words, kernel->wordCount * sizeof(std::uint32_t));
    hashArray(hash, hair.points);
    hashArray(hash, hair.firstPoint);
    hashArray(hash, hair.radii);
    hashArray(hash, hair.colors);
    hash.value(opaque ? hashScene(*opaque) : 0);
    for (const glm::vec3& v : {camera.eye, camera.target, camera.up})
        hash.value(v);
    hash.value(camera.verticalFovDegrees);
    hashSettings(hash, settings);
    return hash.result();
}

void save(const std::filesystem::path& path, std::uint64_t key, const HairFrame& frame)
{
    ByteWriter writer;
    writer.value(kMagic);
    writer.value(kVersion);
    writer.value(key);
    writer.value(frame.radiance.width);
    writer.value(frame.radiance.height);
    writer.array(frame.radiance.pixels);
    writer.array(frame.hair.pixels);
    writer.value(crc32(writer.bytes()));
    try {
        std::filesystem::create_directories(path.parent_path());
        writeFileAtomically(path, writer.bytes());
    } catch (const std::exception& e) {
        logDebug(e.what());
    }
}

HairFrame load(const std::filesystem::path& path, std::uint64_t key)
{
    const std::vector<std::uint8_t> bytes = readFile(path);
    ByteReader reader(bytes, path.string());
    if (reader.value<std::uint32_t>() != kMagic || reader.value<std::uint32_t>() != kVersion ||
        reader.value<std::uint64_t>() != key)
        reader.fail("no truth of this frame");
    const auto width = reader.value<std::uint32_t>();
    const auto height = reader.value<std::uint32_t>();
    HairFrame frame;
    for (CpuImage* image : {&frame.radiance, &frame.hair}) {
        image->width = width;
        image->height = height;
        image->pixels = reader.array<glm::vec4>();
        if (image->pixels.size() != std::size_t(width) * height)
            reader.fail("not as many pixels as the size says");
    }
    const std::uint64_t held = bytes.size() - reader.left();
    if (reader.value<std::uint32_t>() != crc32(std::span(bytes).first(held)))
        reader.fail("the checksum does not fit: the file is damaged");
    reader.finish();
    return frame;
}

std::optional<HairFrame> find(const std::filesystem::path& path, std::uint64_t key)
{
    if (!std::filesystem::exists(path))
        return std::nullopt;
    try {
        return load(path, key);
    } catch (const FileError& e) {
        logDebug(e.what()); // it is made again
        return std::nullopt;
    }
}

} // namespace

HairFrame hairTruth(Context& context, const HairStrands& hair, const Scene* opaque,
                    const Camera& camera, const HairRenderSettings& settings,
                    const std::filesystem::path& folder)
{
    if (settings.mode != HairMode::Reference || settings.distant || settings.background)
        throw Error("hair truth: a reference by punctual light over a plain background, no other");
    if (folder.empty())
        return renderHair(context, hair, opaque, camera, settings);
    const std::uint64_t key = identity(context, hair, opaque, camera, settings);
    char name[48];
    std::snprintf(name, sizeof name, "hair-truth-%016llx.bin",
                  static_cast<unsigned long long>(key));
    if (std::optional<HairFrame> kept = find(folder / name, key))
        return std::move(*kept);
    HairFrame frame = renderHair(context, hair, opaque, camera, settings);
    save(folder / name, key, frame);
    return frame;
}

} // namespace strandlight
