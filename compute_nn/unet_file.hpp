// Which U-Net a file holds, by the shapes of its tensors: a researcher trains elsewhere and says
// nothing more.
#pragma once

#include <string>

#include "compute_nn/network_shapes.hpp"
#include "compute_nn/safetensors.hpp"

namespace strandlight {

// Names as UNetDesc::parameters(), shapes in PyTorch's layout. Reads no more than it needs:
// Parameters::load holds every shape against the network. Throws FileError(path, ...) naming the
// tensor that is missing or has a shape that no U-Net has.
UNetDesc unetOfFile(const Safetensors& file, const std::string& path);

} // namespace strandlight
