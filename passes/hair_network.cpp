#include "passes/hair_network.hpp"

#include "compute_nn/unet_file.hpp"
#include "engine/base/error.hpp"
#include "shaders/shared/hair_types.h"

namespace strandlight {
namespace {

HairNetwork makeNetwork(Context& context, const Safetensors& file, const std::string& name)
{
    const UNetDesc net = unetOfFile(file, name);
    if (net.in != gpu::kHairInputPlanes || net.out != gpu::kHairOutputs || net.levels() > 3)
        throw FileError(name, "",
                        "is a U-Net of " + std::to_string(net.in) + " planes to " +
                            std::to_string(net.out) + " with " + std::to_string(net.levels()) +
                            " levels; the hair filter is one of " +
                            std::to_string(gpu::kHairInputPlanes) + " to " +
                            std::to_string(gpu::kHairOutputs) + " with at most 3");
    HairNetwork network{net, Parameters(context, net.parameters(), 0)};
    network.parameters.load(file, name);
    return network;
}

} // namespace

HairNetwork loadHairNetwork(Context& context, const std::filesystem::path& path)
{
    return makeNetwork(context, Safetensors::load(path), path.string());
}

HairNetwork builtinHairNetwork(Context& context)
{
    if (builtinHairWeights().empty())
        throw Error("hair filter: this program was built without trained weights; give a file of "
                    "them (--weights)");
    return makeNetwork(context, Safetensors::parse(builtinHairWeights(), "built-in weights"),
                       "built-in weights");
}

} // namespace strandlight
