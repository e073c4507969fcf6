#include "passes/hair_training_pool.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include "engine/base/byte_stream.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/progress.hpp"

namespace strandlight {
namespace {

constexpr std::uint32_t kMagic = 0x46544853u; // "SHTF"
constexpr std::uint32_t kVersion = 3;

struct Entry
{
    std::uint32_t index;
    bool heldOut;
};

std::filesystem::path pathOf(const HairPoolSettings& s, Entry entry)
{
    char name[32];
    std::snprintf(name, sizeof name, "%s_%04u.frame", entry.heldOut ? "heldout" : "train",
                  entry.index);
    return s.folder / name;
}

HairTrainingSettings frameSettings(const HairPoolSettings& s, Entry entry)
{
    HairTrainingSettings frame = s.frame;
    frame.targetSamples *= entry.heldOut ? kHeldOutSamples : 1;
    return frame;
}

// What a file must have been made with.
std::uint32_t identity(const HairPoolSettings& s, Entry entry)
{
    ByteWriter writer;
    writer.value(s.seed);
    writer.value(entry.index);
    writer.value(std::uint32_t(entry.heldOut));
    writer.value(frameSettings(s, entry));
    return crc32(writer.bytes());
}

void saveFrame(const HairPoolSettings& s, Entry entry, const HairTrainingFrame& frame)
{
    ByteWriter writer;
    writer.value(kMagic);
    writer.value(kVersion);
    writer.value(identity(s, entry));
    writer.value(frame.size);
    writer.value(frame.repeats);
    writer.value(std::uint32_t(frame.hasAverages));
    writer.array(frame.planes);
    writer.value(crc32(writer.bytes()));
    writeFileAtomically(pathOf(s, entry), writer.bytes());
}

HairTrainingFrame loadFrame(const HairPoolSettings& s, Entry entry)
{
    const std::filesystem::path path = pathOf(s, entry);
    const std::vector<std::uint8_t> bytes = readFile(path);
    ByteReader reader(bytes, path.string());
    if (reader.value<std::uint32_t>() != kMagic || reader.value<std::uint32_t>() != kVersion)
        reader.fail("not a training frame of this version");
    if (reader.value<std::uint32_t>() != identity(s, entry))
        reader.fail("made with another seed or other settings");
    HairTrainingFrame frame;
    frame.size = reader.value<std::uint32_t>();
    frame.repeats = reader.value<std::uint32_t>();
    frame.hasAverages = reader.value<std::uint32_t>() != 0;
    frame.planes = reader.array<std::uint16_t>();
    const std::uint64_t held = bytes.size() - reader.left();
    if (reader.value<std::uint32_t>() != crc32(std::span(bytes).first(held)))
        reader.fail("the checksum does not fit: the file is damaged");
    reader.finish();
    if (frame.size != s.frame.size || frame.repeats != s.frame.repeats ||
        frame.hasAverages != entry.heldOut ||
        frame.planes.size() != frame.planeCount() * frame.size * frame.size)
        reader.fail("the planes do not fit the settings");
    return frame;
}

void fill(Context& context, const HairPoolSettings& s, const std::vector<Entry>& entries)
{
    std::vector<Entry> missing;
    for (const Entry& entry : entries)
        if (!std::filesystem::exists(pathOf(s, entry)))
            missing.push_back(entry);
    if (missing.empty())
        return;
    Progress progress("frames", missing.size());
    for (std::size_t i = 0; i < missing.size(); ++i) {
        throwIfInterrupted();
        const HairTrainingLook look =
            hairTrainingLook(s.seed, missing[i].index, missing[i].heldOut);
        saveFrame(
            s, missing[i],
            makeHairTrainingFrame(context, look, frameSettings(s, missing[i]), missing[i].heldOut));
        progress.update(i + 1);
    }
}

bool showsHair(const HairTrainingFrame& frame)
{
    for (std::uint32_t y = 0; y < frame.size; ++y)
        for (std::uint32_t x = 0; x < frame.size; ++x)
            if (frame.at(frame.targetPlane() + 3, x, y) < 0.9f)
                return true;
    return false;
}

std::string nameOf(const HairTrainingLook& look)
{
    char text[96];
    std::snprintf(text, sizeof text, "%s, %.2f m", look.style.c_str(), double(look.viewHeight));
    return text;
}

} // namespace

HairPool openHairPool(Context& context, const HairPoolSettings& s)
{
    checkHairTrainingSettings(s.frame);
    std::filesystem::create_directories(s.folder);
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < s.heldOut; ++i)
        entries.push_back({i, true});
    for (std::uint32_t i = 0; i < s.frames; ++i)
        entries.push_back({s.first + i, false});
    fill(context, s, entries);
    HairPool pool;
    pool.identity = identity(s, {0, false});
    for (const Entry& entry : entries) {
        HairTrainingFrame frame = loadFrame(s, entry);
        if (!showsHair(frame))
            continue;
        (entry.heldOut ? pool.heldOut : pool.frames).push_back(std::move(frame));
        if (entry.heldOut)
            pool.heldOutNames.push_back(nameOf(hairTrainingLook(s.seed, entry.index, true)));
    }
    return pool;
}

} // namespace strandlight
