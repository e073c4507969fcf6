#include "samples/strandlight/svg_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "passes/pareto.hpp"
#include "samples/strandlight/html.hpp"

namespace strandlight::cli {

namespace {

constexpr double kWidth = 520.0, kHeight = 340.0;
constexpr double kLeft = 58.0, kRight = 16.0, kTop = 30.0, kBottom = 46.0;

std::string coordinate(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

struct Scale
{
    double low, high; // of the data, widened
    double from, to;  // of the picture
    bool logarithmic;

    double unit(double value) const { return logarithmic ? std::log10(value) : value; }
    double at(double value) const
    {
        return from + (to - from) * (unit(value) - unit(low)) / (unit(high) - unit(low));
    }
};

bool drawable(double value, const PlotAxis& axis)
{
    return std::isfinite(value) && (!axis.logarithmic || value > 0.0);
}

std::vector<PlotPoint> drawn(const Plot& plot)
{
    std::vector<PlotPoint> points;
    for (const PlotPoint& point : plot.points)
        if (drawable(point.x, plot.x) && drawable(point.y, plot.y))
            points.push_back(point);
    return points;
}

Scale scaleOf(const std::vector<PlotPoint>& points, double PlotPoint::*value, const PlotAxis& axis,
              double from, double to)
{
    double low = points.front().*value, high = low;
    for (const PlotPoint& point : points) {
        low = std::min(low, point.*value);
        high = std::max(high, point.*value);
    }
    if (axis.logarithmic) {
        // At least a factor of two, so that noise does not fill a plot.
        const double widen = std::pow(std::max(high / low, 2.0), 0.06);
        const double grow = std::max(1.0, std::sqrt(2.0 / (high / low)));
        return {low / widen / grow, high * widen * grow, from, to, true};
    }
    const double room = high > low ? 0.06 * (high - low) : std::max(std::abs(low), 1.0) * 0.5;
    return {low >= 0.0 ? std::max(0.0, low - room) : low - room, high + room, from, to, false};
}

// 0.05, 200, or a power of ten with a raised exponent where digits would be many.
std::string tickText(double value)
{
    char text[64];
    const double power = std::floor(std::log10(std::abs(value)) + 1e-9);
    if (value != 0.0 && (power >= 5.0 || power <= -4.0)) {
        const double factor = value / std::pow(10.0, power);
        std::snprintf(text, sizeof text, "%s10<tspan dy=\"-5\" font-size=\"9\">%.0f</tspan>",
                      factor > 1.5 ? (factor > 3.5 ? "5·" : "2·") : "", power);
    } else {
        std::snprintf(text, sizeof text, "%g", value);
    }
    return text;
}

std::string axes(const Plot& plot, const Scale& x, const Scale& y)
{
    std::string svg = "<g class=\"grid\">";
    std::string labels = "<g class=\"ticks\">";
    for (const double tick : plotTicks(x.low, x.high, x.logarithmic)) {
        const std::string at = coordinate(x.at(tick));
        svg += "<line x1=\"" + at + "\" y1=\"" + coordinate(kTop) + "\" x2=\"" + at + "\" y2=\"" +
               coordinate(kHeight - kBottom) + "\"/>";
        labels += "<text x=\"" + at + "\" y=\"" + coordinate(kHeight - kBottom + 17.0) +
                  "\" text-anchor=\"middle\">" + tickText(tick) + "</text>";
    }
    for (const double tick : plotTicks(y.low, y.high, y.logarithmic)) {
        const double at = y.at(tick);
        svg += "<line x1=\"" + coordinate(kLeft) + "\" y1=\"" + coordinate(at) + "\" x2=\"" +
               coordinate(kWidth - kRight) + "\" y2=\"" + coordinate(at) + "\"/>";
        labels += "<text x=\"" + coordinate(kLeft - 8.0) + "\" y=\"" + coordinate(at + 4.0) +
                  "\" text-anchor=\"end\">" + tickText(tick) + "</text>";
    }
    return svg + "</g>" + labels + "</g><g class=\"labels\"><text x=\"0\" y=\"14\">" +
           escapeHtml(plot.y.label) + "</text><text x=\"" + coordinate(kWidth - kRight) +
           "\" y=\"" + coordinate(kHeight - 6.0) + "\" text-anchor=\"end\">" +
           escapeHtml(plot.x.label) + "</text></g>";
}

std::string line(std::vector<const PlotPoint*> points, const Scale& x, const Scale& y,
                 const std::string& classes)
{
    std::sort(points.begin(), points.end(),
              [](const PlotPoint* a, const PlotPoint* b) { return a->x < b->x; });
    std::string svg = "<polyline class=\"" + classes + "\" points=\"";
    for (const PlotPoint* point : points)
        svg += coordinate(x.at(point->x)) + "," + coordinate(y.at(point->y)) + " ";
    svg.back() = '"';
    return svg + "/>";
}

std::string frontLine(const std::vector<PlotPoint>& points, const Scale& x, const Scale& y)
{
    std::vector<double> costs, errors;
    for (const PlotPoint& point : points) {
        costs.push_back(point.x);
        errors.push_back(point.y);
    }
    const std::vector<bool> front = paretoFront(costs, errors);
    std::vector<const PlotPoint*> on;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (front[i])
            on.push_back(&points[i]);
    return line(on, x, y, "front");
}

int indexOf(const std::vector<std::string>& series, const std::string& name)
{
    return int(std::find(series.begin(), series.end(), name) - series.begin()) % kPlotSeries;
}

} // namespace

std::vector<double> plotTicks(double low, double high, bool logarithmic)
{
    std::vector<double> ticks;
    const auto add = [&](double value) {
        if (value >= low && value <= high)
            ticks.push_back(value);
    };
    if (!logarithmic) {
        const double rough = (high - low) / 6.0;
        const double power = std::pow(10.0, std::floor(std::log10(rough)));
        const double step = power * (rough / power > 5.0   ? 10.0
                                     : rough / power > 2.0 ? 5.0
                                     : rough / power > 1.0 ? 2.0
                                                           : 1.0);
        for (double k = std::ceil(low / step); k * step <= high; ++k)
            add(k * step);
        return ticks;
    }
    const double decades = std::log10(high / low);
    if (decades < 0.7) // too short for powers
        return plotTicks(low, high, false);
    const int stride = decades > 8.0 ? 2 : 1;
    for (int k = int(std::floor(std::log10(low))); k <= int(std::ceil(std::log10(high))); ++k) {
        const double power = std::pow(10.0, k);
        if (k % stride == 0)
            add(power);
        for (const double factor : {2.0, 5.0})
            if (decades <= 3.0)
                add(factor * power);
    }
    return ticks;
}

std::vector<std::string> plotSeries(const Plot& plot)
{
    std::vector<std::string> series;
    for (const PlotPoint& point : drawn(plot))
        if (std::find(series.begin(), series.end(), point.series) == series.end())
            series.push_back(point.series);
    return series;
}

// Shapes differ as well as colours, for eyes and printers that do not see those.
std::string svgMark(int series, double x, double y)
{
    const std::string cx = coordinate(x), cy = coordinate(y);
    const auto path = [&](const char* shape) {
        return "<path transform=\"translate(" + cx + " " + cy + ")\" d=\"" + shape + "\"/>";
    };
    switch (series % 4) {
    case 0:
        return "<circle cx=\"" + cx + "\" cy=\"" + cy + "\" r=\"4.6\"/>";
    case 1:
        return path("M-4.2-4.2h8.4v8.4h-8.4z");
    case 2:
        return path("M0-5.4 5.2 3.9h-10.4z");
    default:
        return path("M0-5.8 5.8 0 0 5.8-5.8 0z");
    }
}

std::string svgPlot(const Plot& plot)
{
    const std::vector<PlotPoint> points = drawn(plot);
    if (points.empty())
        return "";
    const Scale x = scaleOf(points, &PlotPoint::x, plot.x, kLeft, kWidth - kRight);
    const Scale y = scaleOf(points, &PlotPoint::y, plot.y, kHeight - kBottom, kTop);
    const std::vector<std::string> series = plotSeries(plot);
    std::string svg = "<svg class=\"plot\" viewBox=\"0 0 " + coordinate(kWidth) + " " +
                      coordinate(kHeight) + "\" role=\"img\" aria-label=\"" +
                      escapeHtml(plot.title) + "\">" + axes(plot, x, y);
    for (const std::string& name : series) {
        std::vector<const PlotPoint*> members;
        for (const PlotPoint& point : points)
            if (point.series == name)
                members.push_back(&point);
        if (plot.lines && members.size() > 1)
            svg += line(members, x, y, "line s" + std::to_string(indexOf(series, name)));
    }
    if (plot.front)
        svg += frontLine(points, x, y);
    for (const PlotPoint& point : points) {
        const int index = indexOf(series, point.series);
        svg += "<g class=\"mark s" + std::to_string(index) + "\">" +
               svgMark(index, x.at(point.x), y.at(point.y)) + "<title>" +
               escapeHtml(point.details) + "</title></g>";
    }
    return svg + "</svg>";
}

} // namespace strandlight::cli
