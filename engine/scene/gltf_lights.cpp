// Cameras and punctual lights of a glTF file.

#include <cmath>
#include <numbers>

#include "engine/base/log.hpp"
#include "engine/scene/gltf_document.h"

namespace strandlight {

namespace {

// A node's local direction in the world, unit.
glm::vec3 direction(const GltfDocument& document, const glm::dmat4& transform, glm::dvec3 local,
                    const std::string& place)
{
    const glm::dvec3 v = glm::dmat3(transform) * local;
    const double length = glm::length(v);
    if (!(length > 0.0) || !std::isfinite(length))
        document.fail(place, "the node's transform leaves no direction");
    return glm::vec3(v / length);
}

LightType lightType(const GltfDocument& document, const std::string& type, const std::string& place)
{
    if (type == "point")
        return LightType::Point;
    if (type == "spot")
        return LightType::Spot;
    if (type == "directional")
        return LightType::Directional;
    document.fail(place, "light type '" + type + "' is unknown");
}

} // namespace

void appendLight(const GltfDocument& document, int index, const glm::dmat4& transform,
                 const std::string& node, Scene& scene)
{
    const tinygltf::Light& source = document.at(document.model.lights, index, "light", node);
    const std::string place = "light " + std::to_string(index);
    PunctualLight light;
    light.type = lightType(document, source.type, place);
    light.position = glm::vec3(transform[3]);
    light.direction = direction(document, transform, glm::dvec3(0.0, 0.0, -1.0), node);
    light.range = document.readNumber(source.range, place);
    light.intensity = glm::vec3(1.0f);
    document.readNumbers(source.color, {&light.intensity.x, 3}, place);
    light.intensity *= document.readNumber(source.intensity, place);
    const glm::vec3 i = light.intensity;
    if (!(i.x >= 0.0f && i.y >= 0.0f && i.z >= 0.0f) || !std::isfinite(i.x + i.y + i.z) ||
        light.range < 0.0f)
        document.fail(place, "colour, intensity and range must be finite and not negative");
    const double inner = source.spot.innerConeAngle;
    const double outer = source.spot.outerConeAngle;
    if (light.type == LightType::Spot) {
        if (!(inner >= 0.0 && inner < outer && outer <= 0.5 * std::numbers::pi + 1e-6))
            document.fail(place, "needs 0 <= innerConeAngle < outerConeAngle <= pi / 2");
        light.innerConeCos = static_cast<float>(std::cos(inner));
        light.outerConeCos = static_cast<float>(std::cos(outer));
    }
    if (i != glm::vec3(0.0f)) // a dark light lights nothing and costs nothing
        scene.lights.push_back(light);
}

void appendCamera(const GltfDocument& document, int index, const glm::dmat4& transform,
                  const std::string& node, Scene& scene)
{
    const tinygltf::Camera& source = document.at(document.model.cameras, index, "camera", node);
    const std::string place = "camera " + std::to_string(index);
    if (source.type != "perspective") {
        logWarning(document.path.string() + ": " + place + " is not a perspective one, skipped");
        return;
    }
    const double fov = source.perspective.yfov;
    if (!(fov > 0.0 && fov < 0.99 * std::numbers::pi))
        document.fail(place, "yfov of " + std::to_string(fov) + " radians");
    Camera camera;
    camera.eye = glm::vec3(transform[3]);
    camera.target = camera.eye + direction(document, transform, glm::dvec3(0.0, 0.0, -1.0), node);
    camera.up = direction(document, transform, glm::dvec3(0.0, 1.0, 0.0), node);
    camera.verticalFovDegrees = static_cast<float>(fov * 180.0 / std::numbers::pi);
    scene.cameras.push_back(camera);
}

} // namespace strandlight
