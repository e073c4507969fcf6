// Materials and the textures that they use. What no material refers to is never decoded.

#include <algorithm>
#include <cmath>

#include "engine/scene/gltf_document.h"
#include "engine/scene/texture_decode.hpp"

namespace strandlight {

namespace {

constexpr std::uint64_t kMaximumTextureBytes = std::uint64_t(1) << 30;

// A number inside an extension object, or the fallback.
float extensionNumber(const GltfDocument& document, const tinygltf::Value& object, const char* key,
                      float fallback, const std::string& place)
{
    if (!object.IsObject() || !object.Has(key))
        return fallback;
    const tinygltf::Value& value = object.Get(key);
    if (!value.IsNumber())
        document.fail(place, std::string(key) + " is not a number");
    return document.readNumber(value.GetNumberAsDouble(), place);
}

void extensionNumbers(const GltfDocument& document, const tinygltf::Value& object, const char* key,
                      std::span<float> out, const std::string& place)
{
    if (!object.IsObject() || !object.Has(key))
        return;
    const tinygltf::Value& array = object.Get(key);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < array.ArrayLen(); ++i)
        numbers.push_back(array.Get(static_cast<int>(i)).GetNumberAsDouble());
    if (numbers.size() != out.size())
        document.fail(place,
                      std::string(key) + " needs " + std::to_string(out.size()) + " numbers");
    document.readNumbers(numbers, out, place);
}

const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions, const char* name)
{
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

// KHR_texture_transform: scale, then a rotation that is counter-clockwise as seen with v down, then
// the offset.
glm::mat3 textureTransform(const GltfDocument& document, const tinygltf::Value& extension,
                           const std::string& place)
{
    glm::vec2 offset(0.0f);
    glm::vec2 scale(1.0f);
    extensionNumbers(document, extension, "offset", {&offset.x, 2}, place);
    extensionNumbers(document, extension, "scale", {&scale.x, 2}, place);
    const float angle = extensionNumber(document, extension, "rotation", 0.0f, place);
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    return glm::mat3(c * scale.x, -s * scale.x, 0.0f, s * scale.y, c * scale.y, 0.0f, offset.x,
                     offset.y, 1.0f);
}

template <class Info>
TextureSlot readSlot(const GltfDocument& document, const Info& info, GltfTextureCache& textures,
                     const std::string& place)
{
    TextureSlot slot;
    if (info.index < 0)
        return slot;
    slot.texture = textures.load(info.index, place);
    slot.texCoord = info.texCoord;
    if (const tinygltf::Value* extension =
            findExtension(info.extensions, "KHR_texture_transform")) {
        slot.transform = textureTransform(document, *extension, place);
        const float set =
            extensionNumber(document, *extension, "texCoord", float(slot.texCoord), place);
        slot.texCoord = set == 0.0f ? 0 : set == 1.0f ? 1 : -1;
    }
    if (slot.texCoord != 0 && slot.texCoord != 1)
        document.fail(place, "uses a texture coordinate set other than 0 and 1");
    return slot;
}

void readExtensions(const GltfDocument& document, const tinygltf::Material& source,
                    const std::string& place, Material& material)
{
    if (const auto* strength = findExtension(source.extensions, "KHR_materials_emissive_strength"))
        material.emissive *= extensionNumber(document, *strength, "emissiveStrength", 1.0f, place);
    if (const auto* specular = findExtension(source.extensions, "KHR_materials_specular")) {
        material.specular = extensionNumber(document, *specular, "specularFactor", 1.0f, place);
        extensionNumbers(document, *specular, "specularColorFactor", {&material.specularColor.x, 3},
                         place);
    }
}

void checkRanges(const GltfDocument& document, const Material& material, const std::string& place)
{
    const auto inUnit = [](float value) { return value >= 0.0f && value <= 1.0f; };
    const glm::vec4& base = material.baseColor;
    if (!inUnit(base.x) || !inUnit(base.y) || !inUnit(base.z) || !inUnit(base.w) ||
        !inUnit(material.metallic) || !inUnit(material.roughness) || !inUnit(material.specular))
        document.fail(place, "a factor is outside [0, 1]");
    const auto negative = [](glm::vec3 v) { return v.x < 0.0f || v.y < 0.0f || v.z < 0.0f; };
    if (negative(material.emissive) || negative(material.specularColor))
        document.fail(place, "a colour is negative");
    if (!std::isfinite(material.emissive.x + material.emissive.y + material.emissive.z))
        document.fail(place, "the emission is not finite");
}

Material readMaterial(const GltfDocument& document, const tinygltf::Material& source,
                      const std::string& place, GltfTextureCache& textures)
{
    Material material;
    material.name = source.name;
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    document.readNumbers(pbr.baseColorFactor, {&material.baseColor.x, 4}, place);
    document.readNumbers(source.emissiveFactor, {&material.emissive.x, 3}, place);
    material.metallic = document.readNumber(pbr.metallicFactor, place);
    material.roughness = document.readNumber(pbr.roughnessFactor, place);
    material.normalScale = document.readNumber(source.normalTexture.scale, place);
    // Blending needs an order that a light field has not: blended surfaces count as opaque.
    if (source.alphaMode == "MASK")
        material.alphaCutoff = std::max(document.readNumber(source.alphaCutoff, place), 0.0f);
    material.doubleSided = source.doubleSided;
    readExtensions(document, source, place, material);
    checkRanges(document, material, place);

    material.baseColorTexture =
        readSlot(document, pbr.baseColorTexture, textures, place + ", baseColorTexture");
    material.metallicRoughnessTexture = readSlot(document, pbr.metallicRoughnessTexture, textures,
                                                 place + ", metallicRoughnessTexture");
    material.normalTexture =
        readSlot(document, source.normalTexture, textures, place + ", normalTexture");
    // Without an emissive factor the picture is multiplied by nothing.
    if (material.emissive != glm::vec3(0.0f))
        material.emissiveTexture =
            readSlot(document, source.emissiveTexture, textures, place + ", emissiveTexture");
    return material;
}

TextureWrap wrapMode(const GltfDocument& document, int mode, const std::string& place)
{
    switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return TextureWrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return TextureWrap::ClampToEdge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return TextureWrap::MirroredRepeat;
    default:
        document.fail(place, "wrap mode " + std::to_string(mode) + " is unknown");
    }
}

} // namespace

GltfTextureCache::GltfTextureCache(const GltfDocument& document, Scene& scene)
    : document_(document), scene_(scene), loaded_(document.model.textures.size(), -1)
{
}

std::int32_t GltfTextureCache::load(int index, const std::string& place)
{
    const tinygltf::Texture& source =
        document_.at(document_.model.textures, index, "texture", place);
    std::int32_t& slot = loaded_[std::size_t(index)];
    if (slot >= 0)
        return slot;
    const std::string textureName = "texture " + std::to_string(index);
    const tinygltf::Image& image =
        document_.at(document_.model.images, source.source, "image", textureName);
    const std::string name = "image " + std::to_string(source.source) +
                             (image.uri.empty() ? "" : " '" + image.uri + "'");
    std::span<const unsigned char> encoded(image.image);
    if (image.bufferView >= 0)
        encoded = document_.view(image.bufferView, name);
    else if (encoded.empty())
        document_.fail(name, "the image file is missing or empty");

    Image8 decoded = decodeTexture(encoded, document_.path.string() + ": " + name);
    totalBytes_ += decoded.rgba.size();
    if (totalBytes_ > kMaximumTextureBytes)
        document_.fail(name, "the scene's textures exceed 1 GiB");
    Texture texture;
    texture.name = image.name.empty() ? name : image.name;
    texture.width = decoded.width;
    texture.height = decoded.height;
    texture.rgba = std::move(decoded.rgba);
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler =
            document_.at(document_.model.samplers, source.sampler, "sampler", textureName);
        texture.wrapU = wrapMode(document_, sampler.wrapS, textureName);
        texture.wrapV = wrapMode(document_, sampler.wrapT, textureName);
    }
    slot = static_cast<std::int32_t>(scene_.textures.size());
    scene_.textures.push_back(std::move(texture));
    return slot;
}

void readMaterials(const GltfDocument& document, Scene& scene)
{
    GltfTextureCache textures(document, scene);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        const tinygltf::Material& source = document.model.materials[i];
        const std::string place =
            "material " + std::to_string(i) + (source.name.empty() ? "" : " '" + source.name + "'");
        scene.materials.push_back(readMaterial(document, source, place, textures));
    }
    scene.materials.emplace_back().name = "default";
}

} // namespace strandlight
