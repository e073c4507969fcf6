// What can be chosen about baked light: representation, sizes, storage, shading.
#pragma once

#include <cstdint>
#include <string>

#include "passes/bake.hpp"
#include "passes/render_frame.hpp"

namespace strandlight {

enum class GiStorage : std::uint32_t
{
    Fp32,  // as fitted, 28 bytes a lobe
    Fp16,  // halves, axes octahedral 2 x 16 bits: 12 bytes
    Packed // axes octahedral 2 x 12 bits, ln sharpness 8 bits, amplitude RGB9E5: 8 bytes
};

const char* toString(GiStorage storage);
const char* toString(SpecularModel model);
const char* toString(DiffuseModel model);

// What can be chosen; the defaults are those of the bake and of the frame.
struct GiChoice
{
    // "raw images", "SH L1", "SH L2", "fixed SGs", "direct", "cnn" or "cnn+refine"
    std::string representation = toString(BakeSettings{}.fit);
    std::uint32_t lobes = BakeSettings{}.lobes; // of fixed and free SGs
    std::uint32_t atlas = BakeSettings{}.atlasResolution;
    std::uint32_t lightfield = BakeSettings{}.lightfieldSize;
    std::uint32_t samples = BakeSettings{}.samplesPerDirection;
    GiStorage storage = GiStorage::Packed;
    float lobeError = BakeSettings{}.lobeError; // of a fit whose lobes are dropped
    std::uint32_t lobeTile = BakeSettings{}.lobeTile;
    SpecularModel specular = RenderSettings{}.specular;
    DiffuseModel diffuse = RenderSettings{}.diffuse;
};

bool isFree(const GiChoice& choice); // lobes that may move: made by a fit

// The lobes as they come back from storage.
SgField storedAs(const SgField& field, GiStorage storage);

} // namespace strandlight
