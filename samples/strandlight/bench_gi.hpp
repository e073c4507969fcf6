// strandlight bench gi: which scenes, and the study's numbers as rows and plots.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "passes/gi_study.hpp"
#include "samples/strandlight/bench.hpp"

namespace strandlight::cli {

struct GiBenchOptions
{
    BenchOptions common;
    std::vector<std::string> scenes; // empty: the built-in room and what `data` holds
    std::string environment;         // of `scenes`
    std::string data;                // folder with scenes/ and env/
    std::string folder;              // for pictures and truths; empty: none are kept
};

struct GiBenchScene
{
    std::string name;
    SceneOptions files;
    std::string camera; // "": the scene's own
};
std::vector<GiBenchScene> giBenchScenes(const GiBenchOptions& options);

// Rows of one scene: studies "gi" and "fit over time". Adds front flags: "on_bytes_front" (error
// between texels against bytes, same capture) and "on_bake_front" (FLIP against bake seconds).
void addGiRows(Json& rows, const std::string& scene, const GiStudy& study);
void addClosedFormRows(Json& rows); // studies "specular" and "diffuse"

// What the rows say: headline numbers, and the plots and tables of the report.
std::vector<std::string> giScenes(const Json& rows); // in their order
Json giFacts(const Json& rows);
Json giPlots(const Json& rows);
Json giTables();
Json giColumns();

void benchGi(const GiBenchOptions& options);

} // namespace strandlight::cli
