// strandlight bench hair: what is compared, what its rows say, and how the report draws them. A row
// is one method on one scene: "scene", "method" and the numbers of hairColumns().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "passes/hair_network.hpp"
#include "passes/hair_render.hpp"
#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

struct NamedHairNetwork
{
    std::string width;
    HairNetwork network;
};

struct HairMethod
{
    std::string name;
    HairFilter filter = HairFilter::Average;
    std::uint32_t frames = 1;
    HairNetwork* network = nullptr;
    std::uint32_t lod = 1; // 0: by projected width
    bool skipTiles = true;
    bool halves = false; // activations stored as halves
};

// Of the files, or the built-in ones without any. Says which widths are left out; Error when two
// files have the same, for rows are named by it.
std::vector<NamedHairNetwork> openHairNetworks(Context& context,
                                               const std::vector<std::string>& files);

// The first one is what the others' errors are divided by. No average of more than a quarter of the
// truth's samples: its error would be the truth's. `halves`: the device stores them.
std::vector<HairMethod> hairMethods(std::uint32_t truthSamples,
                                    std::vector<NamedHairNetwork>& networks, bool halves);

// Of "4 U-Net small, lod 2": "U-Net small, other settings"; of "16 averaged": "averaged".
std::string hairSeries(const std::string& method);

// A row a method, of the scene kAllScenes: the mean over all scenes of each number.
inline constexpr const char* kAllScenes = "all";
Json hairMeans(const Json& rows);

Json hairFacts(const Json& rows); // headline numbers of rows without means
Json hairPlots(const Json& rows);
Json hairTables(const Json& rows);
Json hairColumns();

} // namespace strandlight::cli
