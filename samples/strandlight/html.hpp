// Pieces of HTML that reports are made of.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "engine/base/image.hpp"

namespace strandlight::cli {

std::string escapeHtml(const std::string& text);         // & < > "
std::string base64(std::span<const std::uint8_t> bytes); // RFC 4648
std::string htmlTable(const std::string& caption, const std::string& rows);
// <img> with the picture inside, as PNG. `image` is linear, 0 to 1.
std::string htmlPicture(const CpuImage& image, const std::string& description,
                        const std::string& classes = "");
// The colours of heatmap() from error 0 to 1.
CpuImage heatScale();
// Two pictures of one size under a slider, and three beside each other.
std::string htmlSwipe(const CpuImage& ours, const CpuImage& truth);
std::string htmlTriptych(const CpuImage& ours, const CpuImage& truth, const CpuImage& heat);

} // namespace strandlight::cli
