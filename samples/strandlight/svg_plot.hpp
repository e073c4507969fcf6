// Scatter and line plots as SVG text: no script, colours by the page's style.
#pragma once

#include <string>
#include <vector>

namespace strandlight::cli {

struct PlotPoint
{
    double x = 0.0;
    double y = 0.0;
    std::string series;
    std::string details; // shown on hover, lines separated by '\n'
};

struct PlotAxis
{
    std::string label; // with unit
    bool logarithmic = true;
};

struct Plot
{
    std::string title; // for readers that do not see
    PlotAxis x;
    PlotAxis y;
    bool lines = false; // joins the points of a series, by x
    bool front = false; // draws the Pareto front of small x and small y
    std::vector<PlotPoint> points;
};

// Points that cannot be drawn (not finite; not positive on a logarithmic axis) are left out. Every
// other is one element of class "mark" and of its series' class s0, s1, ... (in order of first
// appearance, at most kPlotSeries of them look different). Empty when no point is left.
std::string svgPlot(const Plot& plot);

inline constexpr int kPlotSeries = 8;
std::vector<std::string> plotSeries(const Plot& plot); // of the points that are drawn
std::string svgMark(int series, double x, double y);   // the mark alone, for a legend

// Round numbers that cover [low, high]: 1, 2, 5 or powers of ten on a logarithmic axis.
std::vector<double> plotTicks(double low, double high, bool logarithmic);

} // namespace strandlight::cli
