// One HTML file that needs nothing else: pictures inside, system fonts, light and dark.
#pragma once

#include <string>
#include <vector>

#include "engine/base/image.hpp"
#include "engine/base/image_metrics.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

struct ReportPage
{
    std::string title;
    CpuImage picture;   // linear radiance, as the files hold it
    CpuImage reference; // the same size
    float exposure = 0.0f;
    ImageComparison comparison;
    CpuImage flip; // error in x, 0 to 1
    // Whatever `--json` of these commands wrote; null when there is none.
    Json bake;
    Json render;
    Json truth;
};

std::string reportHtml(const ReportPage& page);

// Passes [{name, milliseconds}] with bars, and what was not run and why.
std::string passTable(const std::string& title, const Json& passes, const Json& skipped);

// report_style.cpp
extern const char* const kReportStyle;
extern const char* const kReportScript;

} // namespace strandlight::cli
