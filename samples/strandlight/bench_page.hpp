// The benchmarks as one HTML file that needs nothing else: plots, pictures, tables, light and dark.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

// `benches`: what --json of the benchmarks wrote. Beside its "rows" each may say
//   columns   {key: {label, unit}}
//   facts     [{label, value}]
//   plots     [{title, note, x, y, series, where, log_x, log_y, lines, front}]; x, y and series are
//   keys of rows tables    [{title, note, columns, where}] pictures  [{title, ours, truth, error,
//   caption}]: files in `folder` passes    [{title, rows: [{name, milliseconds}], skipped}]
// `where` {key: value or list of values} chooses rows; a bench without "tables" gets one of all its
// rows. Throws FileError when a picture cannot be read.
std::string benchPageHtml(const std::vector<Json>& benches, const std::filesystem::path& folder);

// bench_page_style.cpp
extern const char* const kBenchPageStyle; // on top of kReportStyle
extern const char* const kBenchPageScript;

} // namespace strandlight::cli
