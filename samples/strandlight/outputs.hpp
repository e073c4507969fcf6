// What the command leaves behind: pictures, and JSON with where it was made.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/base/image.hpp"
#include "engine/scene/scene.hpp"
#include "engine/vk/context.hpp"

namespace strandlight::cli {

using Json = nlohmann::ordered_json;

// Before any work: throws FileError when `path` has none of the suffixes or its folder cannot take
// a file. An empty path (option not given) passes.
void requireOutput(const std::filesystem::path& path, std::initializer_list<const char*> suffixes);

// .png: radiance * 2^exposure, clamped, sRGB. .exr: linear radiance as it is.
void writePicture(const std::filesystem::path& path, const CpuImage& image, float exposure);

// {"command", "version", "commit", "device"}; `context` null: without device.
Json describeRun(const std::string& command, const Context* context);
Json describeCamera(const Camera& camera);
void writeJson(const std::filesystem::path& path, const Json& json); // nothing when path is empty

const char* version();
const char* commit(); // of the checkout when it was configured; "" when unknown

// "%.*f" and the like; `bytes` as KiB or MiB.
std::string fixed(double value, int decimals);
std::string bytesText(std::uint64_t bytes);

} // namespace strandlight::cli
