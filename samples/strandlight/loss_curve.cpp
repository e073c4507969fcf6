#include "samples/strandlight/loss_curve.hpp"

#include <algorithm>
#include <cmath>

#include "samples/strandlight/outputs.hpp"
#include "samples/strandlight/svg_plot.hpp"

namespace strandlight::cli {

namespace {

constexpr double kBinsPerDecade = 40.0;

// A plot takes its colours from its page; this one is a page of its own.
constexpr const char* kHead =
    "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"720\" style=\"background:#fff\"";
constexpr const char* kStyle =
    "<style>text{font:12px sans-serif;fill:#333}.grid line{stroke:#ddd}"
    ".line{fill:none;stroke-width:2}.line.s0{stroke:#3b6fb6}.line.s1{stroke:#c4512d}"
    ".mark.s0{fill:#3b6fb6}.mark.s1{fill:#c4512d}</style>";

void addPoint(Plot& plot, double step, double loss, const std::string& series)
{
    plot.points.push_back(
        {step, loss, series, series + ", step " + fixed(step, 0) + ": " + fixed(loss, 6)});
}

// Means of the losses over steps that are close on a logarithmic axis. Steps that were skipped, of
// no finite loss, are left out.
void addBinned(Plot& plot, const std::vector<float>& losses, const std::string& series)
{
    for (std::size_t first = 0; first < losses.size();) {
        const auto width =
            std::size_t(double(first + 1) * (std::pow(10.0, 1.0 / kBinsPerDecade) - 1.0));
        const std::size_t last = std::min(losses.size(), first + std::max<std::size_t>(1, width));
        double sum = 0.0;
        std::size_t count = 0;
        for (std::size_t i = first; i < last; ++i)
            if (std::isfinite(losses[i])) {
                sum += double(losses[i]);
                ++count;
            }
        if (count > 0)
            addPoint(plot, 0.5 * double(first + 1 + last), sum / double(count), series);
        first = last;
    }
}

} // namespace

std::string lossCurveSvg(const HairTraining& training)
{
    Plot plot{.title = "Loss by step",
              .x = {.label = "steps"},
              .y = {.label = "loss: circles training crops, squares held-out frames"},
              .lines = true};
    addBinned(plot, training.losses, "training crops");
    for (const HairValidationPoint& point : training.validations)
        addPoint(plot, double(point.step), double(point.loss), "held-out frames");
    std::string svg = svgPlot(plot);
    if (svg.empty())
        return std::string(kHead) + "/>\n";
    svg.insert(svg.find('>') + 1, kStyle);
    return kHead + svg.substr(std::string("<svg").size()) + "\n";
}

} // namespace strandlight::cli
