// What a scene lacks costs nothing: no pass, no pipeline, no memory, by counters.
#include <algorithm>
#include <map>

#include <doctest/doctest.h>

#include "passes/skip_study.hpp"

using namespace strandlight;

namespace {

bool runs(const SkipRow& row, const std::string& part)
{
    return std::any_of(row.passes.begin(), row.passes.end(), [&](const std::string& pass) {
        return pass.find(part) != std::string::npos;
    });
}

} // namespace

TEST_CASE("skip: what a scene lacks is not captured, fitted, compiled, allocated or drawn")
{
    const std::vector<SkipRow> rows = studySkips(
        {}, {.atlas = 24, .samples = 1, .steps = 10, .width = 32, .height = 24, .strands = 50});
    std::map<std::string, SkipRow> by;
    for (const SkipRow& row : rows) {
        CAPTURE(row.name);
        CHECK(row.wrong.empty());
        by[row.name] = row;
    }
    // The full scene has all that the others are said to do without.
    const SkipRow& full = rows.front();
    for (const char* part :
         {"sg specular", "sg environment", "prefilter", "sky", "punctual", "hair"})
        CHECK_MESSAGE(runs(full, part), part);
    CHECK(full.environmentLobes > 0);
    CHECK(full.captureDispatches > 0);

    for (const char* name : {"without environment", "without hair", "without lamp",
                             "without metal or gloss", "furnace", "without light", "empty"}) {
        CAPTURE(name);
        CHECK(by[name].pipelines < full.pipelines);
        CHECK(by[name].passes.size() < full.passes.size());
    }
    CHECK(by["without environment"].environmentLobes == 0);
    CHECK(by["without hair"].peakBytes < full.peakBytes);
    CHECK(by["furnace"].environmentLobes == 0);
    CHECK(by["furnace"].passes ==
          std::vector<std::string>{"visibility", "surfaces", "sg diffuse", "downsample"});
    CHECK(by["without light"].captureDispatches == 0);
    CHECK(by["without light"].lobes == 0);
    CHECK(by["empty"].captureDispatches == 0);
    CHECK(by["empty"].pipelines == 0);
    CHECK(by["empty"].peakBytes == 0);
    CHECK(by["empty"].passes.empty());
}
