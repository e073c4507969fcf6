// Strands to a picture by stochastic transparency in four samples a pixel, or by many jittered
// frames of true-width strands as the truth.
// Enderton, Sintorn, Shirley, Luebke. Stochastic Transparency. 2010
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/base/image.hpp"
#include "engine/graph/render_graph.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/hair.hpp"
#include "shaders/shared/hair_types.h"

namespace strandlight {

enum class HairMode : std::uint32_t
{
    Stochastic, // ribbons at least a pixel wide, alpha makes up for the width
    Reference   // ribbons of true width; the samples of all frames resolve them
};

// What becomes of the four samples of a pixel.
enum class HairFilter : std::uint32_t
{
    None,            // the first one alone
    Average,         // their mean
    Coverage,        // their mean, scaled to the exact coverage (Enderton 2010, 3.3)
    AlphaToCoverage, // the mean of the device's own masks, which depend on alpha alone
    Blend,           // no samples: all strands blended by alpha and depth (hair_blend.frag)
    UNet             // a network's answer (hair_filter.hpp); of one frame only
};

struct HairNetwork;

// Light from far away: an environment, or a bake's light field at the hair (hair_distant.hpp).
struct HairDistantLight
{
    std::vector<gpu::HairLobe> lobes; // by falling energy; the last one has sharpness 0
    std::uint32_t mapped = 0;         // so many of the first have shadow maps of their own
    // Opaque geometry beyond the hair has shaped this light already: it hides none of it.
    bool local = false;
};

struct HairRenderSettings
{
    std::uint32_t width = 640;
    std::uint32_t height = 384;
    HairMode mode = HairMode::Stochastic;
    std::uint32_t frames = 1; // averaged; four samples a pixel each, jittered when more than one
    std::uint32_t frameIndex = 0;          // of the first frame: another index is another noise
    glm::vec2 lensShift = glm::vec2(0.0f); // pixels by which the hair moves in the picture
    float alpha = 1.0f;                    // of a strand that covers its pixel, in [0, 1]
    std::uint32_t lod = 0; // draw every lod-th strand lod times wider; 0: by projected width
    bool shadows = true;   // lights' shadow maps of hair and opaque geometry
    std::uint32_t shadowSize = 1024; // texels a side, four samples each
    HairFilter filter = HairFilter::Average;
    HairNetwork* network = nullptr; // of HairFilter::UNet; outlives renderHair
    bool skipTiles = true;          // of that: compute only what hair needs; changes no bit
    bool halves = false;            // of that: activations stored as halves (fp16)
    std::optional<bool> fuseFetch;  // of that: HairFilterSettings::fuseFetch
    bool exactCoverage = false;     // fill HairFrame::exactTransmittance

    float roughness = 0.3f;               // longitudinal, in [0.05, 1] (Chiang 2016)
    float tiltDegrees = 2.0f;             // of the cuticle scales
    glm::vec3 ambient = glm::vec3(0.25f); // radiance from everywhere; an environment's mean
    // Used when the opaque scene has none: towards the light, and its irradiance.
    glm::vec3 keyDirection = glm::vec3(0.4f, 0.8f, 0.5f);
    glm::vec3 keyIrradiance = glm::vec3(3.0f);
    std::optional<HairDistantLight> distant; // in place of ambient and key light

    // What is behind the hair, linear [height, width]: a finished picture of the opaque scene, or,
    // when null, the constant colour with the opaque triangles in plain diffuse shading before it.
    const CpuImage* background = nullptr;
    glm::vec3 backgroundColor = glm::vec3(0.05f);
};

// What a layer of the filter network computed, in tiles of 8x8 pixels of its output.
struct HairTileCount
{
    std::string layer;
    std::uint32_t level = 0; // 0: full size
    std::uint32_t active = 0;
    std::uint32_t all = 0;
    double work = 0.0; // multiply-adds of all tiles
};

struct HairFrame
{
    CpuImage radiance; // linear [height, width], hair over background
    CpuImage hair;     // [height, width] premultiplied hair radiance; w: transmittance in [0, 1]
    CpuImage exactTransmittance;      // [height, width] in x; empty unless asked for
    std::vector<PassTiming> timings;  // GPU milliseconds, summed over frames by pass
    std::vector<std::string> skipped; // what was not needed, and why
    std::vector<HairTileCount> tiles; // of HairFilter::UNet, in order of the layers
    std::uint32_t lod = 1;            // that was used
    std::uint32_t drawnStrands = 0;
    std::uint32_t drawnSegments = 0;
    std::uint32_t blocks = 0;      // of 8x8 pixels; 0 where the exact transmittance is not known
    std::uint32_t emptyBlocks = 0; // that no strand touches: the network leaves them out
};

// Where the samples of frame i lie, off the pixel's by up to a quarter pixel: with the four
// samples' own places that is close to a box of one pixel.
glm::vec2 hairFrameJitter(std::uint32_t frame);

// `opaque` may be null; its triangles hide hair and cast shadows, its punctual lights light it.
// Without strands nothing is created on the device and the picture is the background.
// Throws Error for broken hair (checkHair), a size that is empty or over 8192, a background of
// another size, or settings out of the ranges above.
HairFrame renderHair(Context& context, const HairStrands& hair, const Scene* opaque,
                     const Camera& camera, const HairRenderSettings& settings = {});

} // namespace strandlight
