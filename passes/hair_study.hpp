// Pictures of hair against their truth: held-out frames, the error of a filtered frame, flicker.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/image_metrics.hpp"
#include "engine/scene/camera.hpp"
#include "passes/hair_render.hpp"

namespace strandlight {

struct HairStudyCase
{
    std::string name;
    HairStrands hair;
    Camera camera;
    bool onHead = true; // headScene() under it
};

// Six styles, colours and views. Training sees neither `ponytail` nor the file, nor seeds from 1000
// on. Where `mohawk` is no file, `straight` stands in. `strands` of each at most, 0: the style's.
std::vector<HairStudyCase> heldOutHair(const std::filesystem::path& mohawk, std::uint32_t strands);

struct HairError
{
    ImageComparison picture;
    double coverage = 0.0; // mean |T - truth's T|
};
HairError compareHair(const HairFrame& frame, const HairFrame& truth);

// Mean |moved(x + 1, y) - first(x, y)| of linear radiance where there is hair in either: what
// changes from frame to frame when the picture moves by one pixel (HairRenderSettings::lensShift)
// and nothing else. Throws Error when the sizes differ.
double hairFlicker(const HairFrame& first, const HairFrame& moved);

} // namespace strandlight
