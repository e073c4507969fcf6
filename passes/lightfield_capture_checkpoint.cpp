// Finished texels of a capture as bytes, and back.
#include <algorithm>
#include <string>

#include "engine/base/byte_stream.hpp"
#include "engine/base/file.hpp"
#include "passes/lightfield_capture_state.hpp"

namespace strandlight {
namespace {

constexpr std::uint32_t kMagic = 0x50434c53u; // "SLCP"
constexpr std::uint32_t kVersion = 1;

} // namespace

// What saved bytes must have been made with.
std::uint32_t LightfieldCapture::State::identity() const
{
    ByteWriter writer;
    writer.value(pointsCrc);
    writer.value(settings.size);
    writer.value(settings.samplesPerDirection);
    writer.value(settings.bounces);
    writer.value(settings.seed);
    writer.value(scene.features);
    writer.value(scene.triangleCount);
    return crc32(writer.bytes());
}

std::vector<std::uint8_t> LightfieldCapture::save() const
{
    const State& s = *state_;
    ByteWriter writer;
    writer.value(kMagic);
    writer.value(kVersion);
    writer.value(s.identity());
    writer.value(s.completed);
    writer.value(s.field.clampedCells);
    writer.value(s.statistics);
    writer.array(
        std::vector<std::uint8_t>(s.field.valid.begin(), s.field.valid.begin() + s.completed));
    for (const LightfieldPart& part : s.field.parts) {
        if (part.firstTexel >= s.completed)
            break;
        const std::size_t words =
            std::size_t(std::min(part.texelCount, s.completed - part.firstTexel)) *
            s.field.directionCount();
        const auto finished = [&](const Buffer& buffer) {
            auto all = buffer.downloadAs<std::uint32_t>();
            all.resize(words);
            return all;
        };
        writer.array(finished(part.radiance));
        if (s.field.hasEnvironment)
            writer.array(finished(part.environment));
    }
    return writer.bytes();
}

void LightfieldCapture::restore(std::span<const std::uint8_t> bytes)
{
    State& s = *state_;
    ByteReader reader(bytes, "capture checkpoint");
    if (reader.value<std::uint32_t>() != kMagic || reader.value<std::uint32_t>() != kVersion)
        reader.fail("not a capture of this version");
    if (reader.value<std::uint32_t>() != s.identity())
        reader.fail("made with another scene, atlas or other settings");
    const auto completed = reader.value<std::uint32_t>();
    if (completed > s.field.texelCount)
        reader.fail(std::to_string(completed) + " of " + std::to_string(s.field.texelCount) +
                    " texels are said to be finished");
    const auto clamped = reader.value<std::uint64_t>();
    const auto statistics = reader.value<TraceStatistics>();
    const auto valid = reader.array<std::uint8_t>();
    if (valid.size() != completed)
        reader.fail("the list of valid texels does not fit");
    for (LightfieldPart& part : s.field.parts) {
        if (part.firstTexel >= completed)
            break;
        const std::size_t words =
            std::size_t(std::min(part.texelCount, completed - part.firstTexel)) *
            s.field.directionCount();
        const auto load = [&](Buffer& buffer) {
            const auto image = reader.array<std::uint32_t>();
            if (image.size() != words)
                reader.fail("the images do not fit");
            buffer.upload(std::as_bytes(std::span(image)));
        };
        load(part.radiance);
        if (s.field.hasEnvironment)
            load(part.environment);
    }
    std::copy(valid.begin(), valid.end(), s.field.valid.begin());
    s.field.clampedCells = clamped;
    s.statistics = statistics;
    s.completed = completed;
}

} // namespace strandlight
