#include "engine/scene/scene.hpp"

namespace strandlight {

namespace {

template <class Fold> glm::vec3 foldPositions(const Scene& scene, Fold fold)
{
    if (scene.vertices.empty())
        return glm::vec3(0.0f);
    glm::vec3 result = scene.vertices.front().position;
    for (const Vertex& vertex : scene.vertices)
        result = fold(result, vertex.position);
    return result;
}

} // namespace

glm::vec3 Scene::boundsMin() const
{
    return foldPositions(*this, [](glm::vec3 a, glm::vec3 b) { return glm::min(a, b); });
}

glm::vec3 Scene::boundsMax() const
{
    return foldPositions(*this, [](glm::vec3 a, glm::vec3 b) { return glm::max(a, b); });
}

} // namespace strandlight
