// What the rows of `strandlight bench gi` say: headline numbers.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "samples/strandlight/bench_gi.hpp"

namespace strandlight::cli {

namespace {

Json fact(const std::string& label, const std::string& value)
{
    return {{"label", label}, {"value", value}};
}

// Seconds after which a fit's trace is first at or below `error`; NaN when it never is.
double secondsTo(const Json& rows, const std::string& scene, const char* fit, double error)
{
    for (const Json& row : rows)
        if (row["study"] == "fit over time" && row["scene"] == scene && row["series"] == fit &&
            row["rmse_between"].is_number() && double(row["rmse_between"]) <= error)
            return row["fit_s"];
    return kNotMeasured;
}

// Who has the least error within each budget of bytes from 56 up, where that is not a free fit: ""
// or "raw images at 1024 bytes".
std::string budgetsWithoutFree(const Json& rows, const std::string& scene)
{
    std::map<double, const Json*> best; // of each size
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row.contains("on_bytes_front")) {
            const Json*& slot = best[row["bytes_per_texel"]];
            if (!slot || row["rmse_between"] < (*slot)["rmse_between"])
                slot = &row;
        }
    std::string others;
    const Json* least = nullptr;
    for (const auto& [bytes, row] : best) {
        if (!least || (*row)["rmse_between"] < (*least)["rmse_between"])
            least = row;
        const auto series = (*least)["series"].get<std::string>();
        if (bytes >= 56.0 && !series.starts_with("free"))
            others += (others.empty() ? "" : ", ") + series + " at " + fixed(bytes, 0) + " bytes";
    }
    return others;
}

// A row's value over the base's, as "-42.1 %".
std::string changeOf(const Json& row, const Json& base, const char* key)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%+.1f %%",
                  100.0 * (double(row[key]) / double(base[key]) - 1.0));
    return text;
}

// Who is no worse than the defaults in bytes, bake time and error, and better in one.
std::string defaultsBeatenBy(const Json& rows, const std::string& scene, const Json& base)
{
    constexpr const char* kCosts[] = {"bytes_per_texel", "bake_s", "rmse_between"};
    std::string others;
    for (const Json& row : rows) {
        if (row["study"] != "gi" || row["scene"] != scene || !row.contains("on_bytes_front"))
            continue;
        bool noWorse = true, better = false;
        for (const char* cost : kCosts) {
            noWorse = noWorse && row[cost] <= base[cost];
            better = better || row[cost] < base[cost];
        }
        if (noWorse && better)
            others += (others.empty() ? "" : ", ") + row["name"].get<std::string>();
    }
    return others;
}

void addBaseFacts(const Json& rows, const std::string& scene, const Json& base, Json& facts)
{
    const std::string better = defaultsBeatenBy(rows, scene, base);
    facts.push_back(fact(scene + ": the defaults are on the front of bytes, bake time and error",
                         better.empty() ? "yes" : "no: " + better));
}

// Against the same fit with every lobe kept.
void addDroppedFacts(const Json& rows, const std::string& scene, const Json& whole, Json& facts)
{
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row["knob"] == "dropped lobes")
            facts.push_back(fact(
                scene + ": lobes dropped at --lobe-error " + fixed(row["lobe_error"], 2),
                "bytes " + changeOf(row, whole, "bytes_per_texel") + "; RMSE at texels " +
                    changeOf(row, whole, "rmse_texel") + ", between " +
                    changeOf(row, whole, "rmse_between") + "; FLIP " +
                    changeOf(row, whole, "flip") + ", relMSE " + changeOf(row, whole, "relmse") +
                    "; shading " + changeOf(row, whole, "shading_ms")));
}

void addSceneFacts(const Json& rows, const std::string& scene, Json& facts)
{
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row["knob"] == "base")
            addBaseFacts(rows, scene, row, facts);
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row["knob"] == "representation" &&
            row["representation"] == toString(BakeSettings{}.fit))
            addDroppedFacts(rows, scene, row, facts);
    const std::string others = budgetsWithoutFree(rows, scene);
    facts.push_back(fact(scene + ": free SGs have the least error from 56 bytes a texel up",
                         others.empty() ? "at every budget" : "but for " + others));
    for (const Json& row : rows)
        if (row["study"] == "gi" && row["scene"] == scene && row["knob"] == "representation" &&
            row["representation"] == "cnn") {
            const double target = row["rmse_between"];
            const double cnn = row["fit_s"];
            const double direct = secondsTo(rows, scene, "direct", target);
            facts.push_back(fact(scene + ": cnn's final error between texels, " + fixed(target, 3),
                                 "cnn " + fixed(cnn, 1) + " s, direct " +
                                     (std::isfinite(direct) ? fixed(direct, 2) + " s (" +
                                                                  fixed(direct / cnn, 3) + "x)"
                                                            : std::string("never"))));
        }
}

double meanError(const Json& rows, const char* study, const std::string& series)
{
    double sum = 0.0;
    int count = 0;
    for (const Json& row : rows)
        if (row["study"] == study && row["series"] == series) {
            sum += double(row["error"]);
            ++count;
        }
    return sum / count;
}

double worstError(const Json& rows, const char* study, const std::string& series)
{
    double worst = 0.0;
    for (const Json& row : rows)
        if (row["study"] == study && row["series"] == series)
            worst = std::max(worst, double(row["error"]));
    return worst;
}

} // namespace

Json giFacts(const Json& rows)
{
    Json facts = Json::array();
    for (const std::string& scene : giScenes(rows))
        addSceneFacts(rows, scene, facts);
    const double mixture = meanError(rows, "specular", "mixture (default)");
    const double asg = meanError(rows, "specular", "asg (thesis)");
    facts.push_back(
        fact("glossy closed form, mean error: mixture over the thesis's ASG",
             fixed(mixture, 3) + " / " + fixed(asg, 3) + " = " + fixed(mixture / asg, 3)));
    const double diffuse = worstError(rows, "diffuse", "Tokuyoshi 2024 (default)");
    facts.push_back(fact("diffuse closed form, largest error for sharpness 1e-3 to 1e5",
                         fixed(1e3 * diffuse, 2) + "e-3 of the lobe's energy"));
    return facts;
}

} // namespace strandlight::cli
