// A bake in progress on disk. Which stage it has reached follows from what is there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "passes/lightfield.hpp"
#include "passes/sg_field.hpp"
#include "passes/sg_fit_settings.hpp"

namespace strandlight {

struct BakeCheckpoint
{
    std::uint64_t settingsHash =
        0; // of everything that decides the result; another bake's work is refused
    std::vector<std::uint8_t> capture;   // state of the capture, as LightfieldCapture saved it
    std::optional<SgField> radiance;     // finished set
    std::optional<FitState> radianceFit; // its optimisation, half-way
    std::optional<FitState> environmentFit;
};

// Atomic: an older checkpoint survives until the new one is whole.
void saveCheckpoint(const std::filesystem::path& path, const BakeCheckpoint& checkpoint);

// Throws FileError when the file is broken or belongs to a bake with other settings.
BakeCheckpoint loadCheckpoint(const std::filesystem::path& path, std::uint64_t settingsHash);

} // namespace strandlight
