// `nn check`: runs the op that a safetensors file names on the device and compares every number the
// file holds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/vk/context.hpp"

namespace strandlight {

// Errors are relative, |ours - file| / |file| in the Euclidean norm; of a loss trace, the largest
// single relative error.
inline constexpr double kForwardTolerance = 1e-5;
inline constexpr double kGradientTolerance = 1e-4;
inline constexpr double kTraceTolerance = 1e-4;

struct CheckRow
{
    std::string name; // "y", "dweight", "loss trace", ...
    double error = 0.0;
    double tolerance = 0.0;
    bool pass = false; // false for NaN
};

struct CheckReport
{
    std::string file;
    std::string op;
    std::vector<CheckRow> rows; // never empty
    bool pass() const;
};

// Understands: conv2d, conv_transpose2d (x, weight, bias, y, dy, dx, dweight, dbias), the ONNX ops
// Conv and ConvTranspose (x, weight, bias, y; no dilation, one group), sg_mixture (raw, directions,
// target, radiance, loss, draw) and the U-Net of unet.hpp (its parameters, x, target, y, loss, d.*,
// losses). Throws FileError when the file is broken, names no such op, or lacks or misshapes a
// tensor.
CheckReport checkFile(Context& context, const std::filesystem::path& path);

} // namespace strandlight
