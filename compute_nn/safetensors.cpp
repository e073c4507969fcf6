#include "compute_nn/safetensors.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"

namespace strandlight {

namespace {

using Json = nlohmann::json;
static_assert(std::endian::native == std::endian::little);

// The format's own limit: a larger header is an attack or a mistake.
constexpr std::uint64_t kMaximumHeader = 100'000'000;
// The standard says at most; deeper JSON than this never occurs and would only serve to exhaust the
// stack.
constexpr int kMaximumDepth = 4;

std::uint64_t unsignedValue(const Json& value, const std::string& path, const std::string& place)
{
    if (!value.is_number_unsigned())
        throw FileError(path, place, "is not a whole number from 0");
    return value.get<std::uint64_t>();
}

float halfToFloat(std::uint16_t half)
{
    const std::uint32_t sign = std::uint32_t(half & 0x8000u) << 16;
    const std::uint32_t exponent = (half >> 10) & 31u;
    const std::uint32_t mantissa = half & 0x3ffu;
    if (exponent == 0) // zero and subnormals: mantissa 2^-24
        return std::bit_cast<float>(std::bit_cast<std::uint32_t>(float(mantissa) * 0x1p-24f) |
                                    sign);
    const std::uint32_t wide = exponent == 31 ? 255u : exponent + 112u;
    return std::bit_cast<float>(sign | wide << 23 | mantissa << 13);
}

Json parseHeader(std::span<const std::uint8_t> bytes, const std::string& path)
{
    if (bytes.size() < 8)
        throw FileError(path, "byte 0", "ends before the header length");
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), 8);
    if (length > kMaximumHeader || length > bytes.size() - 8)
        throw FileError(path, "byte 0",
                        "the header has " + std::to_string(length) + " bytes, the file " +
                            std::to_string(bytes.size()));
    bool tooDeep = false;
    const auto watchDepth = [&](int depth, Json::parse_event_t, Json&) {
        tooDeep = tooDeep || depth > kMaximumDepth;
        return !tooDeep;
    };
    const auto text = bytes.subspan(8, length);
    Json header = Json::parse(text.begin(), text.end(), watchDepth, false);
    if (tooDeep || !header.is_object())
        throw FileError(path, "byte 8", "the header is not a JSON object of tensors");
    return header;
}

NamedTensor parseTensor(const Json& entry, std::span<const std::uint8_t> data,
                        const std::string& path, const std::string& place)
{
    for (const char* key : {"dtype", "shape", "data_offsets"})
        if (!entry.is_object() || !entry.contains(key))
            throw FileError(path, place, std::string("has no ") + key);
    const Json& type = entry["dtype"];
    if (type != "F32" && type != "F16")
        throw FileError(path, place, "has type " + type.dump() + "; F32 and F16 are read");
    const std::uint64_t size = type == "F32" ? 4 : 2;

    if (!entry["shape"].is_array() || entry["shape"].size() > 8)
        throw FileError(path, place, "its shape is not a list of at most 8 sizes");
    NamedTensor tensor;
    std::uint64_t elements = 1;
    for (const Json& side : entry["shape"]) {
        tensor.shape.push_back(unsignedValue(side, path, place));
        if (tensor.shape.back() != 0 && elements > data.size() / tensor.shape.back())
            throw FileError(path, place, "its shape has more elements than the file");
        elements *= tensor.shape.back();
    }
    const Json& offsets = entry["data_offsets"];
    if (!offsets.is_array() || offsets.size() != 2)
        throw FileError(path, place, "data_offsets is not a pair");
    const std::uint64_t begin = unsignedValue(offsets[0], path, place);
    const std::uint64_t end = unsignedValue(offsets[1], path, place);
    if (begin > end || end > data.size() || end - begin != elements * size)
        throw FileError(path, place,
                        "bytes " + std::to_string(begin) + " to " + std::to_string(end) + " of " +
                            std::to_string(data.size()) + " do not hold its " +
                            std::to_string(elements) + " elements");

    tensor.values.resize(elements);
    const auto raw = data.subspan(begin, end - begin);
    if (size == 4 && !raw.empty())
        std::memcpy(tensor.values.data(), raw.data(), raw.size());
    for (std::uint64_t i = 0; size == 2 && i < elements; ++i)
        tensor.values[i] = halfToFloat(std::uint16_t(raw[2 * i] | raw[2 * i + 1] << 8));
    return tensor;
}

} // namespace

std::string shapeText(const std::vector<std::uint64_t>& shape)
{
    std::string text;
    for (const std::uint64_t side : shape)
        text += (text.empty() ? "" : ",") + std::to_string(side);
    return "[" + text + "]";
}

Safetensors Safetensors::load(const std::filesystem::path& path)
{
    const std::vector<std::uint8_t> bytes = readFile(path);
    return parse(std::as_bytes(std::span(bytes)), path.string());
}

Safetensors Safetensors::parse(std::span<const std::byte> file, const std::string& name)
{
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(file.data()),
                                              file.size());
    const Json header = parseHeader(bytes, name);
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), 8);
    const auto data = bytes.subspan(8 + length);

    Safetensors result;
    for (const auto& [key, entry] : header.items()) {
        if (key != "__metadata__") {
            result.tensors[key] = parseTensor(entry, data, name, "tensor \"" + key + "\"");
            continue;
        }
        if (!entry.is_object())
            throw FileError(name, "__metadata__", "is not an object");
        for (const auto& [field, value] : entry.items()) {
            if (!value.is_string())
                throw FileError(name, "__metadata__ \"" + field + "\"", "is not text");
            result.metadata[field] = value.get<std::string>();
        }
    }
    return result;
}

void Safetensors::save(const std::filesystem::path& path) const
{
    Json header = Json::object();
    if (!metadata.empty())
        header["__metadata__"] = metadata;
    std::uint64_t offset = 0;
    for (const auto& [name, tensor] : tensors) {
        std::uint64_t elements = 1;
        for (std::uint64_t side : tensor.shape)
            elements *= side;
        if (elements != tensor.values.size())
            throw Error("tensor \"" + name + "\" has " + std::to_string(tensor.values.size()) +
                        " values, its shape asks for " + std::to_string(elements));
        const std::uint64_t end = offset + elements * sizeof(float);
        header[name] = {{"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {offset, end}}};
        offset = end;
    }
    std::string text = header.dump();
    text.resize((text.size() + 7) / 8 * 8, ' '); // data starts aligned

    std::vector<std::uint8_t> bytes(8 + text.size() + offset);
    const std::uint64_t length = text.size();
    std::memcpy(bytes.data(), &length, 8);
    std::memcpy(bytes.data() + 8, text.data(), text.size());
    std::uint8_t* out = bytes.data() + 8 + text.size();
    for (const auto& [name, tensor] : tensors) {
        if (!tensor.values.empty())
            std::memcpy(out, tensor.values.data(), tensor.values.size() * sizeof(float));
        out += tensor.values.size() * sizeof(float);
    }
    writeFileAtomically(path, bytes);
}

} // namespace strandlight
