#include "passes/hair_study.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/error.hpp"
#include "engine/scene/grooms.hpp"
#include "engine/scene/hair_loader.hpp"

namespace strandlight {
namespace {

// hairCamera turned about the vertical axis and raised, both in degrees.
Camera turnedCamera(const HairStrands& hair, float turn, float raise)
{
    Camera camera = hairCamera(hair);
    const float distance = glm::length(camera.eye - camera.target);
    const float a = glm::radians(turn), b = glm::radians(raise);
    camera.eye = camera.target + distance * glm::vec3(std::sin(a) * std::cos(b), std::sin(b),
                                                      std::cos(a) * std::cos(b));
    return camera;
}

struct Held
{
    const char* style;
    std::uint32_t seed;
    glm::vec3 color;
    float turn, raise;
};

HairStudyCase groomCase(const Held& held, std::uint32_t strands)
{
    GroomSettings settings = groomSettings(held.style);
    settings.seed = held.seed;
    settings.color = held.color;
    if (strands > 0)
        settings.strands = std::min(settings.strands, strands);
    HairStudyCase result;
    result.name = held.style;
    result.hair = makeGroom(held.style, settings);
    result.camera = turnedCamera(result.hair, held.turn, held.raise);
    return result;
}

} // namespace

std::vector<HairStudyCase> heldOutHair(const std::filesystem::path& mohawk, std::uint32_t strands)
{
    std::vector<HairStudyCase> cases;
    for (const Held& held : {Held{"ponytail", 1001, {0.62f, 0.44f, 0.24f}, 73.0f, 9.0f},
                             Held{"wavy", 1002, {0.035f, 0.03f, 0.032f}, -37.0f, 17.0f},
                             Held{"curly", 1003, {0.42f, 0.13f, 0.05f}, 151.0f, 5.0f},
                             Held{"short", 1004, {0.55f, 0.55f, 0.57f}, -112.0f, 31.0f},
                             Held{"afro", 1005, {0.11f, 0.065f, 0.045f}, 19.0f, -7.0f}})
        cases.push_back(groomCase(held, strands));
    if (std::filesystem::is_regular_file(mohawk)) {
        HairStudyCase file;
        file.name = "mohawk";
        file.hair = loadHair(mohawk, {});
        file.camera = turnedCamera(file.hair, 58.0f, 12.0f);
        file.onHead = false;
        cases.push_back(std::move(file));
    } else {
        cases.push_back(groomCase({"straight", 1006, {0.3f, 0.1f, 0.25f}, 201.0f, 14.0f}, strands));
    }
    return cases;
}

HairError compareHair(const HairFrame& frame, const HairFrame& truth)
{
    HairError error;
    error.picture = compareImages(frame.radiance, truth.radiance);
    for (std::size_t i = 0; i < frame.hair.pixels.size(); ++i)
        error.coverage += std::abs(double(frame.hair.pixels[i].w - truth.hair.pixels[i].w));
    error.coverage /= double(frame.hair.pixels.size());
    return error;
}

double hairFlicker(const HairFrame& first, const HairFrame& moved)
{
    const CpuImage& a = first.radiance;
    const CpuImage& b = moved.radiance;
    if (a.width != b.width || a.height != b.height)
        throw Error("flicker: frames of different sizes");
    double sum = 0.0;
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < a.height; ++y)
        for (std::uint32_t x = 0; x + 1 < a.width; ++x) {
            if (first.hair.at(x, y).w >= 1.0f && moved.hair.at(x + 1, y).w >= 1.0f)
                continue;
            const glm::vec3 change = glm::abs(glm::vec3(b.at(x + 1, y) - a.at(x, y)));
            sum += double(change.x + change.y + change.z) / 3.0;
            ++count;
        }
    return count > 0 ? sum / double(count) : 0.0;
}

} // namespace strandlight
