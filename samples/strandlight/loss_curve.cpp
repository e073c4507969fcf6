#include "samples/strandlight/loss_curve.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

constexpr double kWidth = 720.0, kHeight = 440.0;
constexpr double kLeft = 70.0, kRight = 20.0, kTop = 40.0, kBottom = 50.0;
constexpr double kBinsPerDecade = 40.0;
constexpr const char* kTrainColor = "#3b6fb6";
constexpr const char* kValidationColor = "#c4512d";

struct Point
{
    double step, loss;
};

// Means of the losses over steps that are close on a logarithmic axis.
std::vector<Point> binned(const std::vector<float>& losses)
{
    std::vector<Point> points;
    for (std::size_t first = 0; first < losses.size();) {
        const auto width =
            std::size_t(double(first + 1) * (std::pow(10.0, 1.0 / kBinsPerDecade) - 1.0));
        const std::size_t last = std::min(losses.size(), first + std::max<std::size_t>(1, width));
        double sum = 0.0;
        for (std::size_t i = first; i < last; ++i)
            sum += double(losses[i]);
        points.push_back({0.5 * double(first + 1 + last), sum / double(last - first)});
        first = last;
    }
    return points;
}

class Axes
{
public:
    explicit Axes(const std::vector<Point>& points)
    {
        low_ = high_ = {points.front().step, std::max(points.front().loss, 1e-12)};
        for (const Point& p : points) {
            const double loss = std::max(p.loss, 1e-12);
            low_ = {std::min(low_.step, p.step), std::min(low_.loss, loss)};
            high_ = {std::max(high_.step, p.step), std::max(high_.loss, loss)};
        }
        high_.step = std::max(high_.step, 10.0 * low_.step);
        low_.loss *= 0.8;
        high_.loss *= 1.25;
    }
    double x(double step) const
    {
        return kLeft + (kWidth - kLeft - kRight) * std::log(step / low_.step) /
                           std::log(high_.step / low_.step);
    }
    double y(double loss) const
    {
        return kTop + (kHeight - kTop - kBottom) *
                          std::log(high_.loss / std::max(loss, low_.loss)) /
                          std::log(high_.loss / low_.loss);
    }
    // 1, 2, 5 of every decade within the range.
    static std::vector<double> ticks(double low, double high)
    {
        std::vector<double> values;
        for (int decade = int(std::floor(std::log10(low))); decade <= int(std::log10(high)) + 1;
             ++decade)
            for (const double digit : {1.0, 2.0, 5.0})
                if (const double v = digit * std::pow(10.0, decade); v >= low && v <= high)
                    values.push_back(v);
        return values;
    }
    std::string grid() const
    {
        std::string svg;
        for (const double step : ticks(low_.step, high_.step)) {
            const std::string at = fixed(x(step), 1);
            svg += "<path d=\"M" + at + " " + fixed(kTop, 0) + "V" + fixed(kHeight - kBottom, 0) +
                   "\" stroke=\"#ddd\"/><text x=\"" + at + "\" y=\"" +
                   fixed(kHeight - kBottom + 18.0, 0) + "\" text-anchor=\"middle\">" +
                   fixed(step, 0) + "</text>\n";
        }
        for (const double loss : ticks(low_.loss, high_.loss)) {
            const std::string at = fixed(y(loss), 1);
            svg += "<path d=\"M" + fixed(kLeft, 0) + " " + at + "H" + fixed(kWidth - kRight, 0) +
                   "\" stroke=\"#ddd\"/><text x=\"" + fixed(kLeft - 6.0, 0) + "\" y=\"" +
                   fixed(y(loss) + 4.0, 1) + "\" text-anchor=\"end\">" + tickText(loss) +
                   "</text>\n";
        }
        return svg;
    }

private:
    static std::string tickText(double value)
    {
        return fixed(value, std::max(0, int(std::ceil(-std::log10(value) - 1e-9))));
    }
    Point low_, high_;
};

std::string line(const Axes& axes, const std::vector<Point>& points, const char* color)
{
    std::string d;
    for (const Point& p : points)
        d += (d.empty() ? "M" : "L") + fixed(axes.x(p.step), 1) + " " + fixed(axes.y(p.loss), 1);
    return d.empty() ? d
                     : "<path d=\"" + d + "\" fill=\"none\" stroke-width=\"2\" stroke=\"" + color +
                           "\"/>\n";
}

std::string label(double x, double y, const char* color, const std::string& text)
{
    return "<text x=\"" + fixed(x, 0) + "\" y=\"" + fixed(y, 0) + "\" fill=\"" + color + "\">" +
           text + "</text>\n";
}

} // namespace

std::string lossCurveSvg(const HairTraining& training)
{
    const std::vector<Point> train = binned(training.losses);
    std::vector<Point> validation;
    for (const HairValidationPoint& point : training.validations)
        validation.push_back({double(point.step), double(point.loss)});
    std::vector<Point> all = train;
    all.insert(all.end(), validation.begin(), validation.end());
    const std::string size = "\"" + fixed(kWidth, 0) + "\" height=\"" + fixed(kHeight, 0) + "\"";
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=" + size +
                      " font-family=\"sans-serif\" font-size=\"12\">\n"
                      "<rect width=" +
                      size + " fill=\"#fff\"/>\n";
    if (!all.empty()) {
        const Axes axes(all);
        svg +=
            axes.grid() + line(axes, train, kTrainColor) + line(axes, validation, kValidationColor);
        for (const Point& p : validation)
            svg += "<circle cx=\"" + fixed(axes.x(p.step), 1) + "\" cy=\"" +
                   fixed(axes.y(p.loss), 1) + "\" r=\"3\" fill=\"" + kValidationColor + "\"/>\n";
    }
    svg += label(kLeft, 20.0, kTrainColor, "training crops");
    svg += label(kLeft + 130.0, 20.0, kValidationColor, "held-out frames");
    svg += label(0.5 * kWidth - 20.0, kHeight - 12.0, "#333", "steps");
    svg += label(8.0, kTop - 8.0, "#333", "loss");
    return svg + "</svg>\n";
}

} // namespace strandlight::cli
