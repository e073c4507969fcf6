// What the rows of `strandlight bench hair` say, and how the report draws them. A row is one method
// on one scene: "scene", "method" and the numbers of hairColumns().
#pragma once

#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

// Of "4 U-Net small, lod 2": "U-Net small, other settings"; of "16 averaged": "averaged".
std::string hairSeries(const std::string& method);

// A row a method, of the scene kAllScenes: the mean over all scenes of each number.
inline constexpr const char* kAllScenes = "all";
Json hairMeans(const Json& rows);

Json hairFacts(const Json& rows); // headline numbers of rows without means
Json hairPlots(const Json& rows);
Json hairTables();
Json hairColumns();

} // namespace strandlight::cli
