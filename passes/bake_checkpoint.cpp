#include "passes/bake_checkpoint.hpp"

#include <span>

#include "engine/base/byte_stream.hpp"
#include "engine/base/file.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kMagic = 0x43424C53; // "SLBC"
constexpr std::uint32_t kVersion = 2;

void writeFit(ByteWriter& out, const std::optional<FitState>& fit)
{
    out.value(std::uint8_t(fit.has_value()));
    if (!fit)
        return;
    out.value(fit->step);
    out.value(fit->skippedSteps);
    out.value(fit->firstLoss);
    out.array(fit->parameters);
    out.array(fit->firstMoments);
    out.array(fit->secondMoments);
}

std::optional<FitState> readFit(ByteReader& in)
{
    if (in.value<std::uint8_t>() == 0)
        return std::nullopt;
    FitState fit;
    fit.step = in.value<std::uint32_t>();
    fit.skippedSteps = in.value<std::uint64_t>();
    fit.firstLoss = in.value<double>();
    fit.parameters = in.array<float>();
    fit.firstMoments = in.array<float>();
    fit.secondMoments = in.array<float>();
    return fit;
}

} // namespace

void saveCheckpoint(const std::filesystem::path& path, const BakeCheckpoint& checkpoint)
{
    ByteWriter body;
    body.value(checkpoint.settingsHash);
    body.array(checkpoint.capture);
    body.value(std::uint8_t(checkpoint.radiance.has_value()));
    if (checkpoint.radiance) {
        body.value(checkpoint.radiance->lobeCount);
        body.array(checkpoint.radiance->lobes);
        body.value(checkpoint.radiance->tileSize);
        body.array(checkpoint.radiance->kept);
    }
    writeFit(body, checkpoint.radianceFit);
    writeFit(body, checkpoint.environmentFit);

    ByteWriter file;
    file.value(kMagic);
    file.value(kVersion);
    file.value(crc32(body.bytes()));
    file.array(body.bytes());
    removeStaleTemporaries(path);
    writeFileAtomically(path, file.bytes());
}

BakeCheckpoint loadCheckpoint(const std::filesystem::path& path, std::uint64_t settingsHash)
{
    const std::vector<std::uint8_t> bytes = readFile(path);
    ByteReader file(bytes, path.string());
    if (file.value<std::uint32_t>() != kMagic)
        file.fail("this is no bake checkpoint");
    if (file.value<std::uint32_t>() != kVersion)
        file.fail("the checkpoint is of another version; bake again without --resume");
    const auto checksum = file.value<std::uint32_t>();
    const std::vector<std::uint8_t> body = file.array<std::uint8_t>();
    if (crc32(body) != checksum)
        file.fail("the checkpoint is damaged (checksum); bake again without --resume");

    ByteReader in(body, path.string());
    BakeCheckpoint out;
    out.settingsHash = in.value<std::uint64_t>();
    if (out.settingsHash != settingsHash)
        in.fail("the checkpoint belongs to another scene or other settings; bake again without "
                "--resume");
    out.capture = in.array<std::uint8_t>();
    if (in.value<std::uint8_t>() != 0) {
        SgField field;
        field.lobeCount = in.value<std::uint32_t>();
        field.lobes = in.array<SgLobe>();
        field.tileSize = in.value<std::uint32_t>();
        field.kept = in.array<std::uint32_t>();
        out.radiance = std::move(field);
    }
    out.radianceFit = readFit(in);
    out.environmentFit = readFit(in);
    return out;
}

} // namespace strandlight
