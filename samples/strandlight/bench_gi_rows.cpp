// Rows, plots and headline numbers of `strandlight bench gi`.
#include <algorithm>
#include <cmath>
#include <functional>

#include "passes/pareto.hpp"
#include "passes/shading_study.hpp"
#include "samples/strandlight/bench_gi.hpp"

namespace strandlight::cli {

namespace {

Json number(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr); // JSON has no NaN
}

// "free, packed": what a mark in a plot of representations is called.
std::string seriesOf(const GiChoice& choice)
{
    if (isFree(choice))
        return "free SGs, " + choice.representation + ", " + toString(choice.storage) +
               (choice.lobeError > 0.0f ? ", dropped" : "");
    return choice.representation.starts_with("SH") ? "spherical harmonics" : choice.representation;
}

std::string nameOf(const GiRow& row)
{
    const GiChoice& c = row.choice;
    if (row.knob == "representation")
        return c.representation +
               (c.representation == "fixed SGs" ? " x " + std::to_string(c.lobes) : "");
    if (row.knob == "lobes and storage")
        return std::to_string(c.lobes) + " lobes, " + toString(c.storage);
    if (row.knob == "dropped lobes")
        return "lobe error " + fixed(c.lobeError, 2);
    if (row.knob == "atlas")
        return "atlas " + std::to_string(c.atlas);
    if (row.knob == "light field")
        return "light field " + std::to_string(c.lightfield);
    if (row.knob == "samples")
        return std::to_string(c.samples) + " paths";
    if (row.knob == "shading")
        return std::string(toString(c.specular)) + " + " + toString(c.diffuse);
    return row.knob;
}

Json rowJson(const std::string& scene, const GiRow& row)
{
    const GiChoice& c = row.choice;
    return {{"name", scene + ", " + nameOf(row)},
            {"study", "gi"},
            {"scene", scene},
            {"knob", row.knob},
            {"series", seriesOf(c)},
            {"representation", c.representation},
            {"lobes", c.lobes},
            {"lobe_error", c.lobeError},
            {"lobe_tile", c.lobeTile},
            {"atlas", c.atlas},
            {"light_field", c.lightfield},
            {"samples", c.samples},
            {"storage", toString(c.storage)},
            {"shading", std::string(toString(c.specular)) + " + " + toString(c.diffuse)},
            {"texels", row.texels},
            {"bytes_per_texel", row.bytesPerTexel},
            {"capture_s", row.captureSeconds},
            {"fit_s", row.fitSeconds},
            {"bake_s", row.bakeSeconds},
            {"shading_ms", number(row.shadingMilliseconds)},
            {"rmse_texel", number(row.texelRmse)},
            {"rmse_between", number(row.betweenRmse)},
            {"flip", number(row.flip)},
            {"relmse", number(row.relMse)},
            {"ssim", number(row.ssim)}};
}

// Says "yes" or "no" under `key` in the rows that `compete`.
void markFront(Json& rows, std::size_t first, const char* key, const char* cost, const char* error,
               const std::function<bool(const Json&)>& competes)
{
    std::vector<std::size_t> which;
    std::vector<double> costs, errors;
    for (std::size_t i = first; i < rows.size(); ++i)
        if (competes(rows[i]) && rows[i][cost].is_number() && rows[i][error].is_number()) {
            which.push_back(i);
            costs.push_back(rows[i][cost]);
            errors.push_back(rows[i][error]);
        }
    const std::vector<bool> front = paretoFront(costs, errors);
    for (std::size_t i = 0; i < which.size(); ++i)
        rows[which[i]][key] = front[i] ? "yes" : "no";
}

} // namespace

void addGiRows(Json& rows, const std::string& scene, const GiStudy& study)
{
    const std::size_t first = rows.size();
    for (const GiRow& row : study.rows)
        rows.push_back(rowJson(scene, row));
    // Rows of one capture compete for bytes; for time all that is drawn with the default shading.
    markFront(rows, first, "on_bytes_front", "bytes_per_texel", "rmse_between", [](const Json& r) {
        return r["knob"] == "representation" || r["knob"] == "lobes and storage" ||
               r["knob"] == "dropped lobes";
    });
    markFront(rows, first, "on_bake_front", "bake_s", "flip",
              [](const Json& r) { return r["knob"] != "shading" && r["knob"] != "base"; });
    for (const GiTracePoint& point : study.traces)
        rows.push_back({{"name", scene + ", " + point.fit},
                        {"study", "fit over time"},
                        {"scene", scene},
                        {"series", point.fit},
                        {"fit_s", point.seconds},
                        {"rmse_between", number(point.betweenRmse)}});
}

void addClosedFormRows(Json& rows)
{
    const auto add = [&](const char* study, const char* series, const char* key, double value,
                         double error) {
        rows.push_back({{"name", std::string(series) + ", " + key + " " + fixed(value, 3)},
                        {"study", study},
                        {"series", series},
                        {key, value},
                        {"error", number(error)}});
    };
    for (const double alpha : {0.05, 0.1, 0.2, 0.4, 0.64, 0.9}) {
        double asg = 0.0, ndf = 0.0,
               mixture = 0.0; // means over sharpness, each cell counting alike
        for (const double sharpness : {1.0, 4.0, 16.0, 64.0, 256.0}) {
            const SpecularErrors e = specularErrors(alpha, sharpness);
            asg += e.asg / e.reference / 5.0;
            ndf += e.ndf / e.reference / 5.0;
            mixture += e.mixture / e.reference / 5.0;
        }
        add("specular", "asg (thesis)", "alpha", alpha, asg);
        add("specular", "ndf filter", "alpha", alpha, ndf);
        add("specular", "mixture (default)", "alpha", alpha, mixture);
    }
    for (const double sharpness :
         {1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e5}) {
        const DiffuseErrors e = diffuseErrors(sharpness);
        add("diffuse", "Wang 2009", "sharpness", sharpness, e.wang);
        add("diffuse", "Hill 2016", "sharpness", sharpness, e.hill);
        add("diffuse", "Tokuyoshi 2024 (default)", "sharpness", sharpness, e.tokuyoshi);
    }
}

} // namespace strandlight::cli
