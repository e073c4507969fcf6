// strandlight stress: the numerical stress matrix, over and over with new seeds until the time is
// up.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/base/progress.hpp"
#include "passes/stress/stress.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    DeviceOptions device;
    double minutes = 1.0;
    StressSettings settings{
        .seed = 1, .items = 16384, .shapes = 24, .steps = 10000, .largest = 10000000};
    std::string group;
    std::string json;
};

// What all rounds of one row added up to.
struct Total
{
    std::string group;
    StressRow row;
    std::uint32_t worstSeed = 0; // of the round that `worst` and `worstInput` come from
};

void addUp(std::vector<Total>& totals, const std::string& group, std::uint32_t seed,
           const std::vector<StressRow>& rows)
{
    for (const StressRow& row : rows) {
        const auto same = [&](const Total& t) {
            return t.group == group && t.row.name == row.name;
        };
        const auto found = std::find_if(totals.begin(), totals.end(), same);
        if (found == totals.end()) {
            totals.push_back({group, row, seed});
            continue;
        }
        StressRow& sum = found->row;
        // A round that misses speaks before one that is only less exact.
        if (std::pair(row.misses > 0, row.worst) > std::pair(sum.misses > 0, sum.worst)) {
            sum.worst = row.worst;
            sum.worstInput = row.worstInput;
            found->worstSeed = seed;
        }
        sum.cases += row.cases;
        sum.refused += row.refused;
        sum.nonFinite += row.nonFinite;
        sum.misses += row.misses;
        sum.clamped += row.clamped;
    }
}

void print(const std::vector<Total>& totals)
{
    std::printf("%-13s %-52s %12s %10s %10s %9s %7s  %s\n", "group", "what", "cases", "refused",
                "clamped", "nonfinite", "misses", "worst / tolerance");
    for (const Total& t : totals) {
        const StressRow& r = t.row;
        std::printf("%-13s %-52s %12llu %10llu %10llu %9llu %7llu  ", t.group.c_str(),
                    r.name.c_str(), static_cast<unsigned long long>(r.cases),
                    static_cast<unsigned long long>(r.refused),
                    static_cast<unsigned long long>(r.clamped),
                    static_cast<unsigned long long>(r.nonFinite),
                    static_cast<unsigned long long>(r.misses));
        if (r.tolerance > 0.0)
            std::printf("%.2f of %.1e (%s)\n", r.worst, r.tolerance, r.unit.c_str());
        else
            std::printf("%s\n", r.unit.c_str());
    }
    for (const Total& t : totals)
        if (t.row.misses > 0)
            std::printf("MISSED  %s: %s: %s\n        again: strandlight stress --group %s --seed "
                        "%u --minutes 0\n",
                        t.group.c_str(), t.row.name.c_str(), t.row.worstInput.c_str(),
                        t.group.c_str(), t.worstSeed);
}

Json describe(const Options& o, const Context& context, const std::vector<Total>& totals,
              std::uint32_t rounds, double seconds)
{
    Json json = describeRun("stress", &context);
    json["settings"] = {
        {"minutes", o.minutes},         {"seed", o.settings.seed},     {"group", o.group},
        {"items", o.settings.items},    {"shapes", o.settings.shapes}, {"steps", o.settings.steps},
        {"largest", o.settings.largest}};
    Json rows = Json::array();
    for (const Total& t : totals)
        rows.push_back({{"group", t.group},
                        {"name", t.row.name},
                        {"cases", t.row.cases},
                        {"refused", t.row.refused},
                        {"clamped", t.row.clamped},
                        {"non_finite", t.row.nonFinite},
                        {"misses", t.row.misses},
                        {"tolerance", t.row.tolerance},
                        {"relative_to", t.row.unit},
                        {"worst_over_tolerance",
                         std::isfinite(t.row.worst) ? Json(t.row.worst) : Json(nullptr)},
                        {"worst_input", t.row.worstInput},
                        {"worst_seed", t.worstSeed}});
    json["result"] = {{"seconds", seconds}, {"rounds", rounds}, {"rows", rows}};
    return json;
}

int run(const Options& o)
{
    using Clock = std::chrono::steady_clock;
    requireOutput(o.json, {".json"});
    Context context = openDevice(o.device);
    const Clock::time_point start = Clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(Clock::now() - start).count();
    };
    std::vector<Total> totals;
    std::uint32_t rounds = 0;
    bool stopped = false;
    Progress::setEnabled(false); // of the fits inside: a group is the unit here
    for (bool timeLeft = true; timeLeft && !stopped; ++rounds) {
        StressSettings settings = o.settings;
        settings.seed += rounds * 1000u; // groups use seeds up to a few hundred above theirs
        // The long training is done once; later rounds have new fields, but a tenth of the steps.
        settings.steps = rounds == 0 ? o.settings.steps : std::max(o.settings.steps / 10, 1u);
        for (const StressGroup& group : stressGroups()) {
            if (!o.group.empty() && o.group != group.name)
                continue;
            stopped = stopped || interruptRequested();
            if (stopped || (!timeLeft && rounds > 0))
                break;
            std::fprintf(stderr, "%.0f of %.0f s, round %u: %s\n", seconds(), o.minutes * 60.0,
                         rounds + 1, group.name);
            try {
                addUp(totals, group.name, settings.seed, group.run(context, settings));
            } catch (const Interrupted&) {
                stopped = true;
            }
            timeLeft = seconds() < o.minutes * 60.0;
        }
    }
    print(totals);
    std::uint64_t cases = 0, nonFinite = 0, misses = 0;
    for (const Total& t : totals) {
        cases += t.row.cases;
        nonFinite += t.row.nonFinite;
        misses += t.row.misses;
    }
    std::printf("%llu cases in %.0f s, %llu non-finite, %llu misses\n",
                static_cast<unsigned long long>(cases), seconds(),
                static_cast<unsigned long long>(nonFinite),
                static_cast<unsigned long long>(misses));
    if (stopped)
        throw Interrupted();
    writeJson(o.json, describe(o, context, totals, rounds, seconds()));
    return misses == 0 ? 0 : 1;
}

} // namespace

Command addStress(CLI::App& parent)
{
    CLI::App* app =
        parent.add_subcommand("stress", "Formulas and kernels on extreme numbers, against double");
    const auto o = std::make_shared<Options>();
    app->add_option("--minutes", o->minutes,
                    "Goes on with new seeds until then; every group runs once in any case")
        ->type_name("M")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10000.0));
    addNumber(*app, "--seed", o->settings.seed, "Of the random numbers", 0u, 0xffffffffu);
    std::vector<std::string> names;
    std::string about;
    for (const StressGroup& group : stressGroups()) {
        names.emplace_back(group.name);
        about += std::string("\n  ") + group.name + ": " + group.about;
    }
    app->add_option("--group", o->group, "One group instead of all")
        ->type_name("NAME")
        ->check(CLI::IsMember(names));
    addNumber(*app, "--items", o->settings.items, "Random inputs of each formula in a round", 512u,
              1000000u);
    addNumber(*app, "--shapes", o->settings.shapes, "Random shapes of each kernel in a round", 1u,
              1000u);
    addNumber(*app, "--steps", o->settings.steps, "Of each adversarial training", 1u, 1000000u);
    addNumber(*app, "--largest", o->settings.largest, "Elements of the largest sum", 1u, 10000000u);
    addJsonOption(*app, o->json);
    addDeviceOptions(*app, o->device);
    addExamples(*app, "  strandlight stress --minutes 10 --json stress.json\n"
                      "  strandlight stress --group lobes --seed 7 --minutes 0\n"
                      "Groups:" +
                          about + "\nExit code 1 when anything missed its tolerance.");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
