// What stands around hair and lights it: the head under a groom, a scene with its bake, or an
// environment.
#pragma once

#include <optional>

#include "passes/hair_render.hpp"
#include "passes/sg_field.hpp"
#include "samples/strandlight/hair_options.hpp"

namespace strandlight::cli {

struct HairSurroundings
{
    std::optional<Scene> opaque; // none: a file's hair alone
    std::optional<SgBake> bake;  // of `opaque`
    std::optional<HairDistantLight> distant;
};

// Without --scene, an environment takes the place of the lamps about the head.
// Throws FileError or Error; --bake without --scene, or of another scene.
HairSurroundings openSurroundings(const HairOptions& options, const HairStrands& hair);

// The baked scene without hair: what is behind it.
CpuImage renderBehind(Context& context, const HairSurroundings& surroundings, const Camera& camera,
                      const HairRenderSettings& settings, HairFrame& record);

} // namespace strandlight::cli
