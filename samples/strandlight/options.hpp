// Options that several subcommands share, and the forms of their values.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/scene/scene.hpp"
#include "engine/vk/context.hpp"

namespace strandlight::cli {

// One subcommand: `run` is called when `app` was on the command line; it returns the exit code.
struct Command
{
    CLI::App* app = nullptr;
    std::function<int()> run;
};

struct DeviceOptions
{
    std::string device;
    bool validation = false;
};
void addDeviceOptions(CLI::App& app, DeviceOptions& options);
Context openDevice(const DeviceOptions& options);

// A scene and what belongs to it from outside.
struct SceneOptions
{
    std::string scene;
    std::string environment;
};
void addSceneOptions(CLI::App& app, SceneOptions& options);
Scene openScene(const SceneOptions& options); // throws FileError or Error

// A picture of it.
struct ViewOptions
{
    std::vector<std::string> outputs;
    std::string size = "640x480";
    std::string camera;
    float exposure = 0.0f; // stops
};
void addViewOptions(CLI::App& app, ViewOptions& options);

struct Size
{
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};
Size parseSize(const std::string& text);                          // "640x480"
Camera chooseCamera(const Scene& scene, const std::string& text); // "": the scene's own

void addJsonOption(CLI::App& app, std::string& path);
// A whole number with limits.
template <class T>
void addNumber(CLI::App& app, const std::string& name, T& value, const std::string& meaning,
               T lowest, T highest)
{
    app.add_option(name, value, meaning)
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(lowest, highest));
}

void addExamples(CLI::App& app, const std::string& lines);

} // namespace strandlight::cli
