// The study behind `bench gi`, in the smallest form that can be wrong.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "engine/scene/scene_loader.hpp"
#include "passes/gi_study.hpp"
#include "tests/support/gltf_maker.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;

namespace {

GiSweep tinySweep()
{
    GiSweep sweep;
    sweep.base.atlas = 12;
    sweep.base.lightfield = 8;
    sweep.base.samples = 4;
    sweep.base.lobes = 4;
    sweep.fits = {"direct"};
    sweep.fixedLobes = {4};
    sweep.lobes = {4};
    sweep.lobeErrors = {0.2f};
    sweep.atlases = {};
    sweep.lightfields = {4};
    sweep.samples = {};
    return sweep;
}

GiMeasureSettings tinyMeasure()
{
    GiMeasureSettings settings;
    settings.width = 32;
    settings.height = 24;
    settings.frames = 1;
    settings.truthSamples = 4;
    settings.fit.bake.bounces = 4;
    settings.fit.bake.steps = 150;
    settings.fit.probes = 24;
    settings.fit.probeSize = 8;
    settings.fit.probeSamples = 4;
    return settings;
}

} // namespace

TEST_CASE("gi study: rows are consistent, and the truth is kept")
{
    const test::TemporaryFolder folder;
    GiMeasureSettings settings = tinyMeasure();
    settings.cache = folder.path();
    const Scene scene = loadScene("builtin:room");
    std::size_t told = 1; // not of the base
    const GiStudy study =
        studyGi(test::context(), scene, tinySweep(), settings, [&](const GiStudy& soFar) {
            CHECK(soFar.rows.size() == ++told);
            CHECK(soFar.traces.size() >= 2);
        });
    CHECK(study.rows.size() == told);

    std::map<std::string, GiRow> ways, stored, shading;
    for (const GiRow& row : study.rows) {
        CAPTURE(row.knob);
        CAPTURE(row.choice.representation);
        CHECK(row.bytesPerTexel > 0.0);
        CHECK(row.betweenRmse > 0.0);
        // Only what has lobes can be drawn.
        CHECK(std::isfinite(row.flip) == (row.choice.representation != "raw images"));
        if (row.knob == "representation")
            ways[row.choice.representation] = row;
        if (row.knob == "lobes and storage")
            stored[toString(row.choice.storage)] = row;
        if (row.knob == "dropped lobes") { // a byte a tile says which
            CHECK(row.bytesPerTexel < 0.9 * ways["direct"].bytesPerTexel);
            CHECK(row.texelRmse < 1.6 * ways["direct"].texelRmse); // 1.2 of the relative error
            CHECK(row.texelRmse != ways["direct"].texelRmse);
        }
        if (row.knob == "shading")
            shading[std::string(toString(row.choice.specular)) + toString(row.choice.diffuse)] =
                row;
    }
    REQUIRE(ways.size() == 5);
    CHECK(ways["raw images"].texelRmse == 0.0);
    CHECK(ways["SH L2"].texelRmse < ways["SH L1"].texelRmse); // nine coefficients against four
    CHECK(ways["direct"].texelRmse < ways["fixed SGs"].texelRmse);
    CHECK(ways["direct"].betweenRmse < ways["fixed SGs"].betweenRmse);
    CHECK(ways["SH L2"].bytesPerTexel == 54.0);

    REQUIRE(stored.size() == 3);
    CHECK(stored["fp32"].bytesPerTexel == 4 * 28.0);
    CHECK(stored["packed"].bytesPerTexel == 4 * 8.0);
    // Eleven and more bits of everything: a thousandth of the error of the lobes themselves; packed
    // amplitudes have nine.
    const double exact = stored["fp32"].betweenRmse;
    CHECK(stored["fp16"].betweenRmse == doctest::Approx(exact).epsilon(1e-3));
    CHECK(stored["packed"].betweenRmse == doctest::Approx(exact).epsilon(2e-2));
    CHECK(stored["packed"].betweenRmse != stored["fp16"].betweenRmse);

    REQUIRE(shading.size() == 5);
    CHECK(shading["mixturetokuyoshi"].flip == study.rows.front().flip); // the same picture
    CHECK(shading["mixturewang"].flip != shading["mixturetokuyoshi"].flip);
    CHECK(shading["asgtokuyoshi"].flip != shading["mixturetokuyoshi"].flip);

    REQUIRE(study.traces.size() >= 2);
    CHECK(study.traces.back().betweenRmse < study.traces.front().betweenRmse); // 150 steps, one

    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
    const GiMeasure again(test::context(), scene, settings);
    REQUIRE(again.truth().pixels.size() == study.truth.pixels.size());
    bool same = true;
    for (std::size_t i = 0; i < study.truth.pixels.size(); ++i)
        same = same && glm::vec3(again.truth().pixels[i]) == glm::vec3(study.truth.pixels[i]);
    CHECK(same);
}
