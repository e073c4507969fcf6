// Accessors to arrays. Every range is computed in 64 bits and checked before the first byte is
// read.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/scene/gltf_document.h"

namespace strandlight {

namespace {

// Accessors without a view are zeros (for sparse data): nothing in the file bounds them, so this
// does.
constexpr std::uint64_t kMaximumZeros = std::uint64_t(1) << 20;

struct Layout
{
    int componentType = 0;
    std::uint64_t componentBytes = 0;
    std::uint64_t components = 0;
    bool normalized = false;

    std::uint64_t elementBytes() const { return componentBytes * components; }
};

// Elements of one accessor or sparse array, known to lie inside their buffer view.
struct Elements
{
    const unsigned char* first = nullptr;
    std::uint64_t stride = 0;

    const unsigned char* at(std::uint64_t index) const { return first + index * stride; }
};

Layout layoutOf(const GltfDocument& document, int componentType, int components, bool normalized,
                const std::string& place)
{
    Layout layout;
    layout.componentType = componentType;
    layout.components = static_cast<std::uint64_t>(components);
    layout.normalized = normalized;
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        layout.componentBytes = 1;
        break;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        layout.componentBytes = 2;
        break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        layout.componentBytes = 4;
        break;
    default:
        document.fail(place, "component type " + std::to_string(componentType) + " is unknown");
    }
    return layout;
}

Elements checkedElements(const GltfDocument& document, int viewIndex, std::uint64_t offset,
                         std::uint64_t count, std::uint64_t elementBytes, bool mayStride,
                         const std::string& place)
{
    const std::span<const unsigned char> view = document.view(viewIndex, place);
    std::uint64_t stride = document.model.bufferViews[std::size_t(viewIndex)].byteStride;
    if (stride == 0 || !mayStride)
        stride = elementBytes;
    if (stride < elementBytes || stride > 252)
        document.fail(place, "stride " + std::to_string(stride) + " for elements of " +
                                 std::to_string(elementBytes) + " bytes");
    // count * stride cannot wrap: count <= size of a view < 2^31 once it passes the first test.
    if (offset > view.size() || count > view.size() ||
        (count > 0 && (count - 1) * stride + elementBytes > view.size() - offset))
        document.fail(place, std::to_string(count) + " elements of " +
                                 std::to_string(elementBytes) + " bytes (stride " +
                                 std::to_string(stride) + ", offset " + std::to_string(offset) +
                                 ") do not fit the bufferView of " + std::to_string(view.size()) +
                                 " bytes");
    return {view.data() + offset, stride};
}

template <class T> T load(const unsigned char* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

float component(const Layout& layout, const unsigned char* bytes)
{
    const auto scaled = [&](float value, float maximum) {
        return layout.normalized ? std::max(value / maximum, -1.0f) : value;
    };
    switch (layout.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return scaled(load<std::int8_t>(bytes), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return scaled(load<std::uint8_t>(bytes), 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return scaled(load<std::int16_t>(bytes), 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return scaled(load<std::uint16_t>(bytes), 65535.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return static_cast<float>(load<std::uint32_t>(bytes));
    default:
        return load<float>(bytes);
    }
}

// Unsigned integers of 1, 2 or 4 bytes.
std::uint32_t unsignedComponent(const Layout& layout, const unsigned char* bytes)
{
    if (layout.componentBytes == 1)
        return load<std::uint8_t>(bytes);
    return layout.componentBytes == 2 ? load<std::uint16_t>(bytes) : load<std::uint32_t>(bytes);
}

Layout indexLayout(const GltfDocument& document, int componentType, const std::string& place)
{
    if (componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        document.fail(place, "indices of component type " + std::to_string(componentType));
    return layoutOf(document, componentType, 1, false, place);
}

void readElement(const Layout& layout, const unsigned char* bytes, float* out)
{
    for (std::uint64_t c = 0; c < layout.components; ++c)
        out[c] = component(layout, bytes + c * layout.componentBytes);
}

// Replaces the elements that the accessor's sparse part lists.
void applySparse(const GltfDocument& document, const tinygltf::Accessor& accessor,
                 const Layout& layout, const std::string& place, std::vector<float>& values)
{
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        std::uint64_t(sparse.count) > accessor.count)
        document.fail(place, "sparse count or offset out of range");
    const auto count = static_cast<std::uint64_t>(sparse.count);
    const Layout index = indexLayout(document, sparse.indices.componentType, place);
    const Elements indices = checkedElements(
        document, sparse.indices.bufferView, std::uint64_t(sparse.indices.byteOffset), count,
        index.elementBytes(), false, place + ", sparse indices");
    const Elements replacements =
        checkedElements(document, sparse.values.bufferView, std::uint64_t(sparse.values.byteOffset),
                        count, layout.elementBytes(), false, place + ", sparse values");
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t target = unsignedComponent(index, indices.at(i));
        if (target >= accessor.count)
            document.fail(place, "sparse index " + std::to_string(target) + " of " +
                                     std::to_string(accessor.count) + " elements");
        readElement(layout, replacements.at(i), values.data() + target * layout.components);
    }
}

} // namespace

std::vector<float> readFloats(const GltfDocument& document, int accessorIndex, int components,
                              const std::string& place)
{
    const tinygltf::Accessor& accessor =
        document.at(document.model.accessors, accessorIndex, "accessor", place);
    const std::string name = place + ", accessor " + std::to_string(accessorIndex);
    if (tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)) != components)
        document.fail(name, "needs " + std::to_string(components) + " components per element");
    const Layout layout =
        layoutOf(document, accessor.componentType, components, accessor.normalized, name);

    std::vector<float> values;
    if (accessor.bufferView < 0) {
        if (accessor.count > kMaximumZeros)
            document.fail(name, std::to_string(accessor.count) + " elements without a bufferView");
        values.resize(accessor.count * layout.components);
    } else {
        const Elements elements =
            checkedElements(document, accessor.bufferView, accessor.byteOffset, accessor.count,
                            layout.elementBytes(), true, name);
        values.resize(accessor.count * layout.components);
        for (std::uint64_t i = 0; i < accessor.count; ++i)
            readElement(layout, elements.at(i), values.data() + i * layout.components);
    }
    if (accessor.sparse.isSparse)
        applySparse(document, accessor, layout, name, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i]))
            document.fail(name,
                          "element " + std::to_string(i / layout.components) + " is not finite");
    }
    return values;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, int accessorIndex,
                                       std::uint64_t limit, const std::string& place)
{
    const tinygltf::Accessor& accessor =
        document.at(document.model.accessors, accessorIndex, "accessor", place);
    const std::string name = place + ", accessor " + std::to_string(accessorIndex);
    if (accessor.type != TINYGLTF_TYPE_SCALAR || accessor.sparse.isSparse)
        document.fail(name, "indices must be plain scalars");
    const Layout layout = indexLayout(document, accessor.componentType, name);
    const Elements elements = checkedElements(document, accessor.bufferView, accessor.byteOffset,
                                              accessor.count, layout.elementBytes(), true, name);
    std::vector<std::uint32_t> indices(accessor.count);
    for (std::uint64_t i = 0; i < accessor.count; ++i) {
        indices[i] = unsignedComponent(layout, elements.at(i));
        if (indices[i] >= limit)
            document.fail(name, "index " + std::to_string(indices[i]) + " of " +
                                    std::to_string(limit) + " vertices");
    }
    return indices;
}

} // namespace strandlight
