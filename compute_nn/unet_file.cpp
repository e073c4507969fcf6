#include "compute_nn/unet_file.hpp"

#include "engine/base/error.hpp"

namespace strandlight {

namespace {

constexpr std::uint32_t kMostLevels = 8;
constexpr std::uint64_t kMostChannels = 1024;

std::string weightName(const char* kind, std::uint32_t level)
{
    return kind + std::to_string(level) + ".weight";
}

// Sides of a weight, all of them sizes that a layer may have.
std::vector<std::uint32_t> sidesOf(const Safetensors& file, const std::string& path,
                                   const std::string& name)
{
    const std::string place = "tensor \"" + name + "\"";
    const auto found = file.tensors.find(name);
    if (found == file.tensors.end())
        throw FileError(path, place, "is missing; this is no U-Net");
    std::vector<std::uint32_t> sides;
    for (const std::uint64_t side : found->second.shape)
        if (side > 0 && side <= kMostChannels)
            sides.push_back(std::uint32_t(side));
    if (sides.size() != 4 || sides.size() != found->second.shape.size())
        throw FileError(path, place,
                        "has shape " + shapeText(found->second.shape) +
                            ", not that of a convolution's weights");
    return sides;
}

} // namespace

UNetDesc unetOfFile(const Safetensors& file, const std::string& path)
{
    UNetDesc net;
    net.down.clear();
    net.up.clear();
    net.head = file.has("enc0.weight") ? sidesOf(file, path, "enc0.weight")[0] : 0;
    net.in = sidesOf(file, path, weightName("enc", net.head > 0 ? 0 : 1))[1];
    net.out = sidesOf(file, path, "out.weight")[0];
    while (file.has(weightName("enc", net.levels() + 1))) {
        if (net.levels() == kMostLevels)
            throw FileError(path, "", "has more than " + std::to_string(kMostLevels) + " levels");
        net.down.push_back(sidesOf(file, path, weightName("enc", net.levels() + 1))[0]);
    }
    for (std::uint32_t l = net.levels(); l-- > 0;) {
        const std::vector<std::uint32_t> sides = sidesOf(file, path, weightName("dec", l));
        net.up.push_back(sides[1]);
        net.upKernel = sides[2];
    }
    if (net.levels() == 0 || (net.upKernel != 2 && net.upKernel != 4))
        throw FileError(path, "tensor \"dec0.weight\"", "its kernel is neither 2x2 nor 4x4");
    return net;
}

} // namespace strandlight
