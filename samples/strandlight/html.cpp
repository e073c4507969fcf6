#include "samples/strandlight/html.hpp"

#include "engine/base/image_io.hpp"
#include "engine/base/image_metrics.hpp"

namespace strandlight::cli {

std::string escapeHtml(const std::string& text)
{
    std::string safe;
    for (const char c : text) {
        switch (c) {
        case '&':
            safe += "&amp;";
            break;
        case '<':
            safe += "&lt;";
            break;
        case '>':
            safe += "&gt;";
            break;
        case '"':
            safe += "&quot;";
            break;
        default:
            safe += c;
        }
    }
    return safe;
}

std::string base64(std::span<const std::uint8_t> bytes)
{
    static const char* const kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

std::string htmlPicture(const CpuImage& image, const std::string& description,
                        const std::string& classes)
{
    return "<img" + (classes.empty() ? "" : " class=\"" + classes + "\"") + " width=\"" +
           std::to_string(image.width) + "\" height=\"" + std::to_string(image.height) +
           "\" alt=\"" + escapeHtml(description) + "\" src=\"data:image/png;base64," +
           base64(encodePng(image)) + "\">";
}

CpuImage heatScale()
{
    CpuImage ramp(256, 8);
    for (std::uint32_t y = 0; y < ramp.height; ++y)
        for (std::uint32_t x = 0; x < ramp.width; ++x)
            ramp.at(x, y) = glm::vec4(float(x) / 255.0f);
    return heatmap(ramp);
}

std::string htmlTable(const std::string& caption, const std::string& rows)
{
    return "<table><caption>" + escapeHtml(caption) + "</caption>\n" + rows + "</table>\n";
}

std::string htmlSwipe(const CpuImage& ours, const CpuImage& truth)
{
    return "<div class=\"swipe\">" + htmlPicture(truth, "path traced") +
           htmlPicture(ours, "rendered", "over") +
           "<div class=\"rule\"></div><span class=\"left\">ours</span>"
           "<span class=\"right\">truth</span>"
           "<input type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" "
           "aria-label=\"Share of the picture that is ours\"></div>\n";
}

std::string htmlTriptych(const CpuImage& ours, const CpuImage& truth, const CpuImage& heat)
{
    return "<div class=\"triptych\">\n<figure>" + htmlPicture(ours, "rendered") +
           "<figcaption>Ours</figcaption></figure>\n<figure>" + htmlPicture(truth, "the truth") +
           "<figcaption>Truth</figcaption></figure>\n<figure>" +
           htmlPicture(heat, "heat map of the FLIP error") +
           "<figcaption>FLIP error <span class=\"scale\">0 " + htmlPicture(heatScale(), "") +
           " 1</span></figcaption></figure>\n</div>\n";
}

} // namespace strandlight::cli
