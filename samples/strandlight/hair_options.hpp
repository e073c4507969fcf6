// Which hair, and what it grows on: options that all pictures of hair share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/scene/hair.hpp"
#include "samples/strandlight/options.hpp"

namespace strandlight::cli {

// Settings of a groom that the user gave; the style decides the others.
struct GroomOptions
{
    std::optional<std::uint32_t> strands; // of a file: so many of them
    std::optional<std::uint32_t> segments;
    std::optional<float> length;
    std::optional<float> clumping;
    std::optional<float> frizz;
    std::optional<float> colorVariation;
    std::optional<std::uint32_t> seed;
};

struct HairOptions
{
    std::string hair;
    std::string scene;
    GroomOptions groom;
    std::string bake;
    std::string environment;
    float width = 1.0f; // factor on all widths
    float scale = 1.0f; // of the hair, before it is moved by
    std::string offset; // metres
};
void addHairOptions(CLI::App& app, HairOptions& options);
HairStrands openHair(const HairOptions& options); // throws FileError or Error

bool isGroom(const HairOptions& options);

} // namespace strandlight::cli
