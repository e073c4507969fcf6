// The area of a strip within a pixel: against sums over a fine grid, and strips that tile the
// plane.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include <doctest/doctest.h>

#include "shaders/shared/hair_coverage.h"

using namespace strandlight;

namespace {

// Share of 800 x 800 places of the unit square that lie in the strip.
double countedArea(double width, double distance, double angle)
{
    constexpr int kPlaces = 800;
    const double nx = std::cos(angle), ny = std::sin(angle);
    int inside = 0;
    for (int j = 0; j < kPlaces; ++j)
        for (int i = 0; i < kPlaces; ++i) {
            const double x = (i + 0.5) / kPlaces - 0.5, y = (j + 0.5) / kPlaces - 0.5;
            inside += std::abs(nx * x + ny * y - distance) <= 0.5 * width ? 1 : 0;
        }
    return double(inside) / (double(kPlaces) * kPlaces);
}

glm::vec2 normalAt(double angle)
{
    return {float(std::cos(angle)), float(std::sin(angle))};
}

} // namespace

TEST_CASE("hair strip area: is what a fine grid counts")
{
    for (const double width : {0.05, 0.4, 1.0, 3.0})
        for (const double distance : {0.0, 0.2, -0.45, 0.6, 1.3, -2.0})
            for (const double angle : {0.0, 0.3, 0.7853981, 1.2, 1.5707963, 2.5, 4.0}) {
                CAPTURE(width);
                CAPTURE(distance);
                CAPTURE(angle);
                // A strip's two edges pass at most 2 * sqrt(2) * 800 of 800^2 places closely.
                CHECK(std::abs(double(gpu::hairStripArea(float(width), float(distance),
                                                         normalAt(angle))) -
                               countedArea(width, distance, angle)) < 2.0 * 1.42 / 800.0);
            }
}

TEST_CASE("hair strip area: pixels of a row share a strip's area out between them")
{
    // Along x, n.x is the step between pixels' distances: the strip's area in the row is w / n.x.
    for (const float width : {0.02f, 0.3f, 1.0f, 2.5f})
        for (int i = 0; i <= 40; ++i) {
            const double angle = 0.7853981 * double(i) / 40.0;
            const glm::vec2 n = normalAt(angle);
            double sum = 0.0;
            for (int k = -8; k <= 8; ++k)
                sum += double(gpu::hairStripArea(width, 0.171f + float(k) * n.x, n));
            CAPTURE(width);
            CAPTURE(angle);
            // Areas are differences of numbers up to 1: 17 of them, each within 2^-24.
            CHECK(std::abs(sum - double(width / n.x)) < 2e-6 + 2e-6 * double(width));
        }
}

TEST_CASE("hair strip area: rectangles end to end add up, quarters to their pixel")
{
    for (int i = 0; i < 64; ++i) {
        const double angle = 0.1 * double(i);
        const glm::vec2 direction = normalAt(angle);
        const float width = 0.05f + 0.02f * float(i), across = 0.01f * float(i - 32);
        // One of length 0.9 in the pixel, and the same cut in three.
        const float whole = gpu::hairRectangleArea(width, across, 0.9f, 0.1f, direction);
        const float parts = gpu::hairRectangleArea(width, across, 0.2f, -0.25f, direction) +
                            gpu::hairRectangleArea(width, across, 0.4f, 0.05f, direction) +
                            gpu::hairRectangleArea(width, across, 0.3f, 0.4f, direction);
        CHECK(parts == doctest::Approx(whole).epsilon(1e-5));
        // A strip through the whole pixel: its quarters' areas are exact, and so is their mean.
        const glm::vec4 q = gpu::hairQuarterAreas(width, across, 8.0f, 0.0f, direction);
        const glm::vec2 normal(-direction.y, direction.x);
        CHECK(0.25f * (q.x + q.y + q.z + q.w) ==
              doctest::Approx(gpu::hairStripArea(width, across, normal)).epsilon(1e-4));
        for (int k = 0; k < 4; ++k) {
            CHECK(q[k] >= 0.0f);
            CHECK(q[k] <= 1.0f);
        }
    }
    // A level rectangle over the left half, of y from -1/2 to 0: the first quarter, in full.
    const glm::vec4 q = gpu::hairQuarterAreas(0.5f, -0.25f, 0.5f, -0.25f, {1.0f, 0.0f});
    CHECK(q.x == doctest::Approx(1.0f));
    CHECK(q.y == doctest::Approx(0.0f));
    CHECK(q.z == doctest::Approx(0.0f));
    CHECK(q.w == doctest::Approx(0.0f));
}

TEST_CASE("hair strip area: nothing beyond reach, all of the pixel within a wide strip, no sign")
{
    for (int i = 0; i < 64; ++i) {
        const glm::vec2 n = normalAt(0.1 * double(i));
        CHECK(gpu::hairStripArea(0.3f, 0.5f * (0.3f + gpu::kHairPixelReach) + 1e-4f, n) == 0.0f);
        CHECK(gpu::hairStripArea(4.0f, 0.9f, n) == 1.0f);
        CHECK(gpu::hairStripArea(0.0f, 0.2f, n) == 0.0f);
        CHECK(gpu::hairStripArea(0.4f, 0.3f, n) == gpu::hairStripArea(0.4f, -0.3f, -n));
    }
}
