#include "engine/scene/gltf_loader.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/base/file.hpp"
#include "engine/base/log.hpp"
#include "engine/scene/gltf_document.h"

namespace strandlight {

namespace {

constexpr int kMaximumNodeDepth = 64;

// `out` from JSON numbers, kept as it is when they are absent.
template <std::size_t N>
void readDoubles(const GltfDocument& document, const std::vector<double>& numbers, double (&out)[N],
                 const std::string& place)
{
    if (numbers.empty())
        return;
    if (numbers.size() != N)
        document.fail(place, "a transform of " + std::to_string(numbers.size()) + " numbers");
    for (std::size_t i = 0; i < N; ++i) {
        if (!std::isfinite(numbers[i]))
            document.fail(place, "a transform is not finite");
        out[i] = numbers[i];
    }
}

glm::dmat4 localTransform(const GltfDocument& document, const tinygltf::Node& node,
                          const std::string& place)
{
    if (!node.matrix.empty()) {
        double m[16] = {};
        readDoubles(document, node.matrix, m, place);
        glm::dmat4 matrix(1.0);
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 4; ++row)
                matrix[column][row] = m[column * 4 + row];
        }
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
            document.fail(place, "the matrix is not affine");
        return matrix;
    }
    double translation[3] = {0.0, 0.0, 0.0};
    double rotation[4] = {0.0, 0.0, 0.0, 1.0};
    double scale[3] = {1.0, 1.0, 1.0};
    readDoubles(document, node.translation, translation, place);
    readDoubles(document, node.rotation, rotation, place);
    readDoubles(document, node.scale, scale, place);
    const glm::dquat turn(rotation[3], rotation[0], rotation[1], rotation[2]); // w, x, y, z
    const double length = glm::length(turn);
    if (!(length > 1e-6) || !std::isfinite(length))
        document.fail(place, "the rotation is not a quaternion");
    const glm::dvec3 t(translation[0], translation[1], translation[2]);
    const glm::dvec3 s(scale[0], scale[1], scale[2]);
    return glm::scale(glm::translate(glm::dmat4(1.0), t) * glm::mat4_cast(turn / length), s);
}

class NodeWalker
{
public:
    NodeWalker(const GltfDocument& document, Scene& scene)
        : document_(document), scene_(scene), visited_(document.model.nodes.size(), false)
    {
    }

    void visit(int index, const glm::dmat4& parent, int depth, const std::string& from);
    GltfProgress progress;

private:
    void appendMesh(int index, const glm::dmat4& transform, const std::string& place);

    const GltfDocument& document_;
    Scene& scene_;
    std::vector<bool> visited_;
};

void NodeWalker::appendMesh(int index, const glm::dmat4& transform, const std::string& place)
{
    const tinygltf::Mesh& mesh = document_.at(document_.model.meshes, index, "mesh", place);
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i)
        appendPrimitive(document_, mesh.primitives[i], transform,
                        "mesh " + std::to_string(index) + ", primitive " + std::to_string(i),
                        scene_, progress);
}

void NodeWalker::visit(int index, const glm::dmat4& parent, int depth, const std::string& from)
{
    const tinygltf::Node& node = document_.at(document_.model.nodes, index, "node", from);
    const std::string place = "node " + std::to_string(index);
    if (depth > kMaximumNodeDepth)
        document_.fail(place, "nested deeper than " + std::to_string(kMaximumNodeDepth));
    if (visited_[std::size_t(index)])
        document_.fail(place, "is reached twice: nodes must form a tree");
    visited_[std::size_t(index)] = true;

    const glm::dmat4 transform = parent * localTransform(document_, node, place);
    if (node.mesh >= 0)
        appendMesh(node.mesh, transform, place);
    if (node.camera >= 0)
        appendCamera(document_, node.camera, transform, place, scene_);
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end() && light->second.IsObject() && light->second.Has("light")) {
        const double number = light->second.Get("light").GetNumberAsDouble();
        const bool valid = number >= 0.0 && number < 1e6;
        appendLight(document_, valid ? static_cast<int>(number) : -1, transform, place, scene_);
    }
    for (const int child : node.children)
        visit(child, transform, depth + 1, place);
}

// The nodes to start from: the default scene's, the first scene's, or all that are nobody's child.
std::vector<int> rootNodes(const GltfDocument& document)
{
    const tinygltf::Model& model = document.model;
    if (model.defaultScene >= 0 || !model.scenes.empty())
        return document.at(model.scenes, std::max(model.defaultScene, 0), "scene", "scene").nodes;
    std::vector<bool> isChild(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            document.at(model.nodes, child, "node", "nodes");
            isChild[std::size_t(child)] = true;
        }
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < isChild.size(); ++i) {
        if (!isChild[i])
            roots.push_back(static_cast<int>(i));
    }
    return roots;
}

void dropUnusedDefaultMaterial(Scene& scene)
{
    const auto last = static_cast<std::uint32_t>(scene.materials.size() - 1);
    if (std::find(scene.triangleMaterials.begin(), scene.triangleMaterials.end(), last) ==
        scene.triangleMaterials.end())
        scene.materials.pop_back();
}

void report(const GltfDocument& document, const GltfProgress& progress)
{
    const std::string file = document.path.string();
    if (progress.skippedPrimitives > 0)
        logWarning(file + ": " + std::to_string(progress.skippedPrimitives) +
                   " primitives of points or lines skipped");
    if (progress.degenerateTriangles > 0)
        logDebug(file + ": " + std::to_string(progress.degenerateTriangles) +
                 " triangles without area dropped");
}

} // namespace

Scene parseGltf(std::span<const std::uint8_t> bytes, const std::filesystem::path& path)
{
    const GltfDocument document = readGltfDocument(bytes, path);
    Scene scene;
    scene.name = path.filename().string();
    readMaterials(document, scene);
    NodeWalker walker(document, scene);
    for (const int root : rootNodes(document))
        walker.visit(root, glm::dmat4(1.0), 0, "scene");
    if (scene.triangles.empty() && !document.model.meshes.empty()) // without meshes: as intended
        document.fail("", "the scene has no triangles");
    scene.hasTexCoord1 = walker.progress.allHaveTexCoord1;
    dropUnusedDefaultMaterial(scene);
    report(document, walker.progress);
    return scene;
}

Scene loadGltf(const std::filesystem::path& path)
{
    return parseGltf(readFile(path, kMaximumFileBytes), path);
}

} // namespace strandlight
