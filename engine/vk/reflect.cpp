#include "engine/vk/reflect.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <unordered_map>

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

// The few SPIR-V opcodes and enumerants that reflection reads (SPIR-V specification 1.6, section
// 3).
enum Op : std::uint32_t
{
    OpExecutionMode = 16,
    OpTypeInt = 21,
    OpTypeFloat = 22,
    OpTypeVector = 23,
    OpTypeMatrix = 24,
    OpTypeImage = 25,
    OpTypeSampledImage = 27,
    OpTypeArray = 28,
    OpTypeStruct = 30,
    OpTypePointer = 32,
    OpConstant = 43,
    OpSpecConstant = 50,
    OpSpecConstantComposite = 51,
    OpVariable = 59,
    OpDecorate = 71,
    OpMemberDecorate = 72,
    OpExecutionModeId = 331
};
constexpr std::uint32_t kDecorationSpecId = 1, kDecorationBuiltIn = 11, kDecorationNonWritable = 24,
                        kDecorationBinding = 33, kDecorationDescriptorSet = 34,
                        kDecorationOffset = 35, kDecorationArrayStride = 6,
                        kDecorationMatrixStride = 7;
constexpr std::uint32_t kBuiltInWorkgroupSize = 25, kModeLocalSize = 17, kModeLocalSizeId = 38;
constexpr std::uint32_t kStorageUniformConstant = 0, kStoragePushConstant = 9,
                        kStorageStorageBuffer = 12;
constexpr std::uint32_t kDimBuffer = 5;

struct Instruction
{
    std::uint32_t op = 0;
    std::vector<std::uint32_t> words; // operands, without the first word
};

struct Decorations
{
    std::map<std::uint32_t, std::uint32_t> values; // decoration -> operand
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>>
        members; // member -> decoration -> operand
};

struct Module
{
    std::unordered_map<std::uint32_t, Instruction> byId; // types, constants, variables
    std::unordered_map<std::uint32_t, Decorations> decorations;
    std::vector<std::uint32_t> variables;
    std::vector<std::uint32_t> localSize, localSizeIds;

    const Instruction& get(std::uint32_t id) const { return byId.at(id); }
    std::uint32_t constant(std::uint32_t id) const { return get(id).words.at(2); }
};

Module parse(const KernelBlob& blob)
{
    Module module;
    for (std::size_t at = 5; at < blob.wordCount;) {
        const std::uint32_t op = blob.words[at] & 0xFFFFu, count = blob.words[at] >> 16;
        if (count == 0 || at + count > blob.wordCount)
            throw Error(std::string("shader ") + blob.name + ": broken SPIR-V");
        Instruction in{op, {blob.words + at + 1, blob.words + at + count}};
        at += count;
        const std::vector<std::uint32_t>& w = in.words;
        switch (op) {
        case OpDecorate:
            module.decorations[w[0]].values[w[1]] = w.size() > 2 ? w[2] : 0;
            break;
        case OpMemberDecorate:
            module.decorations[w[0]].members[w[1]][w[2]] = w.size() > 3 ? w[3] : 0;
            break;
        case OpExecutionMode:
            if (w[1] == kModeLocalSize)
                module.localSize = {w[2], w[3], w[4]};
            break;
        case OpExecutionModeId:
            if (w[1] == kModeLocalSizeId)
                module.localSizeIds = {w[2], w[3], w[4]};
            break;
        case OpTypeInt:
        case OpTypeFloat:
        case OpTypeVector:
        case OpTypeMatrix:
        case OpTypeImage:
        case OpTypeSampledImage:
        case OpTypeArray:
        case OpTypeStruct:
        case OpTypePointer:
            module.byId[w[0]] = std::move(in);
            break;
        case OpConstant:
        case OpSpecConstant:
        case OpSpecConstantComposite:
            module.byId[w[1]] = std::move(in);
            break;
        case OpVariable:
            module.variables.push_back(w[1]);
            module.byId[w[1]] = std::move(in);
            break;
        default:
            break;
        }
    }
    return module;
}

// Bytes of a type under scalar or std430 layout, from its explicit offsets and strides.
std::uint32_t typeBytes(const Module& module, std::uint32_t id)
{
    const Instruction& type = module.get(id);
    switch (type.op) {
    case OpTypeInt:
    case OpTypeFloat:
        return type.words[1] / 8;
    case OpTypeVector:
        return typeBytes(module, type.words[1]) * type.words[2];
    case OpTypeMatrix:
        return typeBytes(module, type.words[1]) * type.words[2];
    case OpTypeArray: {
        const auto found = module.decorations.find(id);
        const std::uint32_t stride = found == module.decorations.end()
                                         ? typeBytes(module, type.words[1])
                                         : found->second.values.at(kDecorationArrayStride);
        return stride * module.constant(type.words[2]);
    }
    case OpTypeStruct: {
        std::uint32_t bytes = 0;
        const Decorations& decorations = module.decorations.at(id);
        for (std::uint32_t member = 0; member + 1 < type.words.size(); ++member) {
            const auto& fields = decorations.members.at(member);
            const Instruction& memberType = module.get(type.words[member + 1]);
            std::uint32_t size = typeBytes(module, type.words[member + 1]);
            if (const auto stride = fields.find(kDecorationMatrixStride);
                memberType.op == OpTypeMatrix && stride != fields.end())
                size = stride->second * memberType.words[2];
            bytes = std::max(bytes, fields.at(kDecorationOffset) + size);
        }
        return bytes;
    }
    default:
        return 0;
    }
}

ReflectedBinding reflectVariable(const KernelBlob& blob, const Module& module,
                                 std::uint32_t variable)
{
    const Decorations& decorations = module.decorations.at(variable);
    if (const auto set = decorations.values.find(kDecorationDescriptorSet);
        set != decorations.values.end() && set->second != 0)
        throw Error(std::string("shader ") + blob.name + ": only descriptor set 0 is used here");
    ReflectedBinding out;
    out.binding = decorations.values.at(kDecorationBinding);
    out.readOnly = decorations.values.count(kDecorationNonWritable) != 0;
    const std::uint32_t typeId = module.get(module.get(variable).words[0]).words[2];
    const Instruction& type = module.get(typeId);
    const std::uint32_t storage = module.get(variable).words[2];
    if (storage == kStorageStorageBuffer) {
        out.kind = BindingKind::StorageBuffer;
        bool all = true;
        const auto found = module.decorations.find(typeId);
        for (std::uint32_t m = 0; m + 1 < type.words.size(); ++m)
            all = all && found != module.decorations.end() && found->second.members.count(m) &&
                  found->second.members.at(m).count(kDecorationNonWritable);
        out.readOnly = out.readOnly || all;
    } else if (type.op == OpTypeSampledImage) {
        out.kind = BindingKind::SampledImage;
        out.readOnly = true;
    } else if (type.op == OpTypeImage && type.words[6] == 2) {
        out.kind = type.words[2] == kDimBuffer ? BindingKind::StorageTexelBuffer
                                               : BindingKind::StorageImage;
        out.imageFormat = type.words[7];
    } else {
        throw Error(std::string("shader ") + blob.name + ", binding " +
                    std::to_string(out.binding) +
                    ": use a storage buffer, imageBuffer, image or combined sampler");
    }
    return out;
}

void reflectLocalSize(const Module& module, Reflection& out)
{
    if (!module.localSize.empty())
        std::copy_n(module.localSize.begin(), 3, out.localSize.begin());
    std::vector<std::uint32_t> ids = module.localSizeIds;
    for (const auto& [id, decorations] : module.decorations)
        if (const auto builtIn = decorations.values.find(kDecorationBuiltIn);
            builtIn != decorations.values.end() && builtIn->second == kBuiltInWorkgroupSize)
            ids.assign(module.get(id).words.begin() + 2, module.get(id).words.begin() + 5);
    for (std::size_t axis = 0; axis < ids.size(); ++axis) {
        out.localSize[axis] = module.constant(ids[axis]);
        const auto found = module.decorations.find(ids[axis]);
        if (found != module.decorations.end() && found->second.values.count(kDecorationSpecId))
            out.localSizeIds[axis] = found->second.values.at(kDecorationSpecId);
    }
}

} // namespace

const char* toString(BindingKind kind)
{
    static const char* const kNames[] = {"storage buffer", "texel buffer", "storage image",
                                         "sampled image"};
    return kNames[std::size_t(kind)];
}

std::array<std::uint32_t, 3>
Reflection::localSizeWith(std::span<const std::uint32_t> constants) const
{
    std::array<std::uint32_t, 3> size = localSize;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (localSizeIds[axis] < constants.size())
            size[axis] = constants[localSizeIds[axis]];
    return size;
}

Reflection reflect(const KernelBlob& blob)
{
    const Module module = parse(blob);
    Reflection out;
    for (const std::uint32_t variable : module.variables) {
        const std::uint32_t storage = module.get(variable).words[2];
        if (storage == kStoragePushConstant)
            out.pushBytes = typeBytes(module, module.get(module.get(variable).words[0]).words[2]);
        else if (storage == kStorageStorageBuffer || storage == kStorageUniformConstant)
            out.bindings.push_back(reflectVariable(blob, module, variable));
        else if (storage == 2)
            throw Error(std::string("shader ") + blob.name + ": uniform buffers are not used here");
    }
    std::sort(out.bindings.begin(), out.bindings.end(),
              [](const auto& a, const auto& b) { return a.binding < b.binding; });
    reflectLocalSize(module, out);
    return out;
}

} // namespace strandlight
