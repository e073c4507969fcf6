// The built-in network holds still what four samples let flicker.
#include <doctest/doctest.h>

#include "engine/scene/hair_head.hpp"
#include "passes/hair_network.hpp"
#include "passes/hair_study.hpp"
#include "tests/support/gpu_fixture.hpp"

using namespace strandlight;
using namespace strandlight::test;

TEST_CASE("hair filter: a camera move of a pixel flickers half as much as four samples averaged")
{
    REQUIRE_FALSE(builtinHairWeights().empty());
    HairNetwork network = builtinHairNetwork(context());
    const Scene head = headScene();
    const HairStudyCase subject = heldOutHair({}, 1000)[2]; // curly
    const auto flicker = [&](HairFilter filter) {
        HairRenderSettings settings;
        settings.width = 160;
        settings.height = 96;
        settings.lod = 1;
        settings.filter = filter;
        settings.network = filter == HairFilter::UNet ? &network : nullptr;
        const HairFrame first =
            renderHair(context(), subject.hair, &head, subject.camera, settings);
        settings.frameIndex = 1;
        settings.lensShift = {1.0f, 0.0f};
        return hairFlicker(first,
                           renderHair(context(), subject.hair, &head, subject.camera, settings));
    };
    const double averaged = flicker(HairFilter::Average);
    const double filtered = flicker(HairFilter::UNet);
    CAPTURE(averaged);
    CAPTURE(filtered);
    CHECK_GT(averaged, 1e-3);
    CHECK_LE(filtered, 0.5 * averaged);
    CHECK_EQ(context().validationMessages(), 0);
}
