#include "samples/strandlight/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/image_io.hpp"

namespace strandlight::cli {

namespace fs = std::filesystem;

void requireOutput(const fs::path& path, std::initializer_list<const char*> suffixes)
{
    if (path.empty())
        return;
    const std::string suffix = path.extension().string();
    if (std::none_of(suffixes.begin(), suffixes.end(),
                     [&](const char* known) { return suffix == known; })) {
        std::string choices;
        for (const char* known : suffixes)
            choices += (choices.empty() ? "" : " or ") + std::string(known);
        throw FileError(path.string(), "", "the name of this output must end in " + choices);
    }
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(folder, error))
        throw FileError(path.string(), "", "there is no folder " + folder.string());
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw FileError(path.string(), "", "cannot write into the folder " + folder.string());
    if (fs::is_directory(path, error))
        throw FileError(path.string(), "", "is a folder");
}

void writePicture(const fs::path& path, const CpuImage& image, float exposure)
{
    if (path.extension() == ".exr")
        return saveExr(path, image);
    CpuImage exposed = image;
    const float factor = std::exp2(exposure);
    for (glm::vec4& pixel : exposed.pixels)
        pixel = glm::vec4(glm::vec3(pixel) * factor, pixel.a);
    savePng(path, exposed);
}

Json describeRun(const std::string& command, const Context* context)
{
    Json run;
    run["command"] = command;
    run["version"] = version();
    run["commit"] = commit();
    if (context)
        run["device"] = {{"name", context->device().name},
                         {"driver", context->device().driver},
                         {"type", context->device().type}};
    return run;
}

Json describeCamera(const Camera& camera)
{
    return {{"eye", {camera.eye.x, camera.eye.y, camera.eye.z}},
            {"target", {camera.target.x, camera.target.y, camera.target.z}},
            {"vertical_degrees", camera.verticalFovDegrees}};
}

void writeJson(const fs::path& path, const Json& json)
{
    if (!path.empty())
        writeFileAtomically(path, json.dump(2) + "\n");
}

const char* version()
{
    return STRANDLIGHT_VERSION;
}

const char* commit()
{
    return STRANDLIGHT_COMMIT;
}

std::string fixed(double value, int decimals)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

std::string bytesText(std::uint64_t bytes)
{
    if (bytes < 1024)
        return std::to_string(bytes) + " B";
    if (bytes < 1024 * 1024)
        return fixed(double(bytes) / 1024.0, 1) + " KiB";
    return fixed(double(bytes) / (1024.0 * 1024.0), 1) + " MiB";
}

} // namespace strandlight::cli
