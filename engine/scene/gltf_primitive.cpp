// One glTF primitive to world-space triangles.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/scene/gltf_document.h"
#include "engine/scene/tangents.hpp"

namespace strandlight {

namespace {

// A triangle whose height is below this share of its longest edge has no usable normal in fp32.
constexpr float kDegenerateRatio = 1e-7f;

struct Attributes
{
    std::uint64_t count = 0;
    std::vector<float> positions; // [count, 3]
    std::vector<float> normals;   // [count, 3] or empty
    std::vector<float> tangents;  // [count, 4] or empty
    std::vector<float> uv0;       // [count, 2] or empty
    std::vector<float> uv1;       // [count, 2] or empty
};

struct Transform
{
    explicit Transform(const glm::dmat4& node)
        : matrix(node), linear(node), flips(glm::determinant(linear) < 0.0)
    {
        // The cofactors are the inverse transpose times the determinant: no division, so flat
        // scales work too.
        normal = glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
        if (flips)
            normal = -normal;
    }

    glm::dmat4 matrix;
    glm::dmat3 linear;
    glm::dmat3 normal;
    bool flips; // mirrored: winding and handedness change
};

std::vector<float> readAttribute(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                 const char* name, int components, std::uint64_t count,
                                 const std::string& place)
{
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end())
        return {};
    std::vector<float> values =
        readFloats(document, found->second, components, place + ", " + name);
    if (values.size() != count * std::uint64_t(components))
        document.fail(place + ", " + name,
                      std::to_string(values.size() / std::uint64_t(components)) + " elements for " +
                          std::to_string(count) + " vertices");
    return values;
}

void charge(const GltfDocument& document, std::uint64_t elements, const std::string& place,
            GltfProgress& progress)
{
    progress.elementsRead += elements;
    if (progress.elementsRead > kMaximumElements)
        document.fail(place, "the scene exceeds " + std::to_string(kMaximumElements) +
                                 " triangles and vertices");
}

Attributes readAttributes(const GltfDocument& document, const tinygltf::Primitive& primitive,
                          const std::string& place, GltfProgress& progress)
{
    Attributes attributes;
    const int accessor = primitive.attributes.at("POSITION");
    attributes.count = document.at(document.model.accessors, accessor, "accessor", place).count;
    charge(document, attributes.count, place, progress);
    const auto read = [&](const char* name, int components) {
        return readAttribute(document, primitive, name, components, attributes.count, place);
    };
    attributes.positions = read("POSITION", 3);
    attributes.normals = read("NORMAL", 3);
    attributes.tangents = read("TANGENT", 4);
    attributes.uv0 = read("TEXCOORD_0", 2);
    attributes.uv1 = read("TEXCOORD_1", 2);
    return attributes;
}

// Corner indices of triangle `t` in a list, strip or fan of `mode`.
glm::uvec3 cornersOf(int mode, std::uint32_t t)
{
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        return t % 2 == 0 ? glm::uvec3(t, t + 1, t + 2) : glm::uvec3(t, t + 2, t + 1);
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        return glm::uvec3(t + 1, t + 2, 0);
    return glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
}

std::vector<glm::uvec3> readTriangles(const GltfDocument& document,
                                      const tinygltf::Primitive& primitive,
                                      std::uint64_t vertexCount, const std::string& place,
                                      GltfProgress& progress)
{
    std::vector<std::uint32_t> indices;
    std::uint64_t cornerCount = vertexCount;
    if (primitive.indices >= 0) {
        cornerCount =
            document.at(document.model.accessors, primitive.indices, "accessor", place).count;
        charge(document, cornerCount / 3, place, progress);
        indices = readIndices(document, primitive.indices, vertexCount, place);
    }
    const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    if (list && cornerCount % 3 != 0)
        document.fail(place, std::to_string(cornerCount) + " corners do not make triangles");
    const std::uint64_t count = list ? cornerCount / 3 : cornerCount < 3 ? 0 : cornerCount - 2;
    std::vector<glm::uvec3> triangles(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3 c = cornersOf(primitive.mode, t);
        triangles[t] = indices.empty() ? c : glm::uvec3(indices[c.x], indices[c.y], indices[c.z]);
    }
    return triangles;
}

glm::dvec3 vectorAt(const std::vector<float>& values, std::size_t index, std::size_t stride)
{
    const float* v = values.data() + index * stride;
    return glm::dvec3(v[0], v[1], v[2]);
}

class PrimitiveWriter
{
public:
    PrimitiveWriter(const Attributes& attributes, const Transform& transform, Scene& scene)
        : attributes_(attributes), transform_(transform), scene_(scene)
    {
        positions_.reserve(attributes.count);
        for (std::size_t i = 0; i < attributes.count; ++i) {
            const glm::dvec4 local(vectorAt(attributes.positions, i, 3), 1.0);
            positions_.emplace_back(glm::dvec3(transform.matrix * local));
        }
        if (!attributes.normals.empty()) // flat shading shares no vertex
            written_.resize(attributes.count, kNone);
    }

    glm::vec3 position(std::uint32_t index) const { return positions_[index]; }

    std::uint32_t vertex(std::uint32_t index, glm::vec3 faceNormal);

private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    glm::vec3 direction(glm::dvec3 v, glm::vec3 fallback) const
    {
        const double length = glm::length(v);
        return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
    }

    const Attributes& attributes_;
    const Transform& transform_;
    Scene& scene_;
    // In the world, rounded to fp32 in memory: GCC 12 at -O3 leaves out the rounding of double to
    // float and back where it sees both, and then the same triangle is degenerate or not by
    // optimisation level.
    std::vector<glm::vec3> positions_;
    std::vector<std::uint32_t> written_;
};

std::uint32_t PrimitiveWriter::vertex(std::uint32_t index, glm::vec3 faceNormal)
{
    if (!written_.empty() && written_[index] != kNone)
        return written_[index];
    Vertex vertex;
    vertex.position = position(index);
    vertex.normal = faceNormal;
    if (!attributes_.normals.empty())
        vertex.normal =
            direction(transform_.normal * vectorAt(attributes_.normals, index, 3), faceNormal);
    if (!attributes_.tangents.empty()) {
        const glm::vec3 tangent = direction(
            transform_.linear * vectorAt(attributes_.tangents, index, 4), glm::vec3(1, 0, 0));
        const bool negative = attributes_.tangents[index * 4 + 3] < 0.0f;
        vertex.tangent = glm::vec4(tangent, negative != transform_.flips ? -1.0f : 1.0f);
    }
    if (!attributes_.uv0.empty())
        vertex.uv0 = glm::vec2(attributes_.uv0[index * 2], attributes_.uv0[index * 2 + 1]);
    if (!attributes_.uv1.empty())
        vertex.uv1 = glm::vec2(attributes_.uv1[index * 2], attributes_.uv1[index * 2 + 1]);
    const auto place = static_cast<std::uint32_t>(scene_.vertices.size());
    scene_.vertices.push_back(vertex);
    if (!written_.empty())
        written_[index] = place;
    return place;
}

// The unit normal, or nothing when the triangle has no area in fp32.
std::optional<glm::vec3> faceNormal(const glm::vec3 p[3])
{
    const glm::dvec3 ab = glm::dvec3(p[1]) - glm::dvec3(p[0]);
    const glm::dvec3 ac = glm::dvec3(p[2]) - glm::dvec3(p[0]);
    const glm::dvec3 bc = ac - ab;
    const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    const glm::dvec3 normal = glm::cross(ab, ac);
    const double twiceArea = glm::length(normal);
    if (!(twiceArea > kDegenerateRatio * longest))
        return std::nullopt;
    return glm::vec3(normal / twiceArea);
}

std::uint32_t materialOf(const GltfDocument& document, const tinygltf::Primitive& primitive,
                         const Scene& scene, const std::string& place)
{
    if (primitive.material < 0)
        return static_cast<std::uint32_t>(scene.materials.size() - 1);
    document.at(document.model.materials, primitive.material, "material", place);
    return static_cast<std::uint32_t>(primitive.material);
}

// A texture without coordinates would be one stretched texel: refused rather than drawn.
void checkTextureCoordinates(const GltfDocument& document, const Attributes& attributes,
                             const Material& material, const std::string& place)
{
    for (const TextureSlot* slot : {&material.baseColorTexture, &material.metallicRoughnessTexture,
                                    &material.normalTexture, &material.emissiveTexture})
        if (slot->texture >= 0 && (slot->texCoord == 0 ? attributes.uv0 : attributes.uv1).empty())
            document.fail(place, "material '" + material.name + "' has a texture at TEXCOORD_" +
                                     std::to_string(slot->texCoord) +
                                     ", which the primitive does not bring");
}

} // namespace

void appendPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive,
                     const glm::dmat4& node, const std::string& place, Scene& scene,
                     GltfProgress& progress)
{
    if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        ++progress.skippedPrimitives;
        return;
    }
    if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        document.fail(place, "mode " + std::to_string(primitive.mode) + " is unknown");
    if (primitive.attributes.count("POSITION") == 0)
        document.fail(place, "has no POSITION");
    const Attributes attributes = readAttributes(document, primitive, place, progress);
    const std::vector<glm::uvec3> triangles =
        readTriangles(document, primitive, attributes.count, place, progress);
    const std::uint32_t material = materialOf(document, primitive, scene, place);
    checkTextureCoordinates(document, attributes, scene.materials[material], place);
    progress.allHaveTexCoord1 = progress.allHaveTexCoord1 && !attributes.uv1.empty();

    const Transform transform(node);
    PrimitiveWriter writer(attributes, transform, scene);
    const std::size_t firstTriangle = scene.triangles.size();
    for (glm::uvec3 corners : triangles) {
        if (transform.flips)
            std::swap(corners.y, corners.z);
        const glm::vec3 p[3] = {writer.position(corners.x), writer.position(corners.y),
                                writer.position(corners.z)};
        for (const glm::vec3& q : p) {
            if (!std::isfinite(q.x) || !std::isfinite(q.y) || !std::isfinite(q.z))
                document.fail(place, "a transformed position is not finite");
        }
        const std::optional<glm::vec3> normal = faceNormal(p);
        if (!normal) {
            ++progress.degenerateTriangles;
            continue;
        }
        // One after another: the order of arguments would be the compiler's choice, and with it the
        // vertices'.
        glm::uvec3 triangle;
        for (int k = 0; k < 3; ++k)
            triangle[k] = writer.vertex(corners[k], *normal);
        scene.triangles.push_back(triangle);
        scene.triangleMaterials.push_back(material);
    }
    const TextureSlot& normalMap = scene.materials[material].normalTexture;
    if (normalMap.texture >= 0 && (attributes.tangents.empty() || attributes.normals.empty()))
        generateTangents(scene, firstTriangle, normalMap);
}

} // namespace strandlight
