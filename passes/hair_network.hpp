// A trained hair filter: its layers and its weights on the device.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "compute_nn/network_shapes.hpp"
#include "compute_nn/parameters.hpp"

namespace strandlight {

struct HairNetwork
{
    UNetDesc net;
    Parameters parameters;
};

// A safetensors file in PyTorch's layout (unet_file.hpp). Throws FileError naming tensor and
// shapes when it is no network of 26 planes to 12.
HairNetwork loadHairNetwork(Context& context, const std::filesystem::path& path);

// The weights that the program was built with (passes/weights/hair_unet.safetensors). Throws Error
// when it was built without.
HairNetwork builtinHairNetwork(Context& context);

// That file's bytes; empty when there was none.
std::span<const std::byte> builtinHairWeights();

} // namespace strandlight
