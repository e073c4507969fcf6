#include "samples/strandlight/options.hpp"

#include <charconv>
#include <cmath>

#include "engine/base/error.hpp"
#include "engine/base/image_io.hpp"
#include "engine/scene/camera.hpp"
#include "engine/scene/environment.hpp"
#include "engine/scene/scene_loader.hpp"

namespace strandlight::cli {

namespace {

constexpr char kSizeForm[] = "is not WIDTHxHEIGHT in pixels, e.g. 640x480";
constexpr char kCameraForm[] =
    "is not EX,EY,EZ,TX,TY,TZ[,FOVY]: six or seven numbers, eye and target apart";

// False unless all of `text` is one number.
template <class T> bool parseNumber(std::string_view text, T& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::optional<Size> sizeFrom(const std::string& text)
{
    const std::size_t cross = text.find('x');
    Size size;
    if (cross == std::string::npos ||
        !parseNumber(std::string_view(text).substr(0, cross), size.width) ||
        !parseNumber(std::string_view(text).substr(cross + 1), size.height))
        return std::nullopt;
    const bool fits = size.width > 0 && size.height > 0 && size.width <= kMaximumImageSide &&
                      size.height <= kMaximumImageSide &&
                      std::uint64_t(size.width) * size.height <= kMaximumImagePixels;
    return fits ? std::optional(size) : std::nullopt;
}

std::optional<Camera> cameraFrom(const std::string& text)
{
    std::vector<float> numbers;
    for (const std::string& part : CLI::detail::split(text, ',')) {
        float number = 0.0f;
        if (!parseNumber(part, number) || !std::isfinite(number))
            return std::nullopt;
        numbers.push_back(number);
    }
    if (numbers.size() != 6 && numbers.size() != 7)
        return std::nullopt;
    Camera camera;
    camera.eye = {numbers[0], numbers[1], numbers[2]};
    camera.target = {numbers[3], numbers[4], numbers[5]};
    if (numbers.size() == 7)
        camera.verticalFovDegrees = numbers[6];
    const bool usable = camera.eye != camera.target && camera.verticalFovDegrees > 0.0f &&
                        camera.verticalFovDegrees < 179.0f;
    return usable ? std::optional(camera) : std::nullopt;
}

} // namespace

void addDeviceOptions(CLI::App& app, DeviceOptions& options)
{
    app.add_option("--device", options.device,
                   "Index or part of the name; `strandlight info` lists them")
        ->type_name("DEVICE");
    app.add_flag("--validation", options.validation, "Run under the Vulkan validation layers");
}

Context openDevice(const DeviceOptions& options)
{
    ContextSettings settings;
    settings.device = options.device;
    settings.validation = options.validation;
    return Context::headless(settings);
}

void addSceneOptions(CLI::App& app, SceneOptions& options)
{
    app.add_option("SCENE", options.scene,
                   ".gltf, .glb, builtin:room, builtin:bust, builtin:box or builtin:furnace[:ALBEDO]")
        ->required()
        ->type_name("");
    app.add_option("--env", options.environment, "Distant environment, lat-long .hdr or .exr")
        ->type_name("FILE");
}

Scene openScene(const SceneOptions& options)
{
    Scene scene = loadScene(options.scene);
    if (!options.environment.empty())
        scene.environment = loadEnvironment(options.environment);
    return scene;
}

void addViewOptions(CLI::App& app, ViewOptions& options)
{
    app.add_option("-o,--output", options.outputs,
                   ".png (exposed, sRGB) or .exr (linear); may be given again for the other")
        ->required()
        ->expected(1)
        ->take_all()
        ->type_name("FILE");
    app.add_option("--size", options.size, "Of the picture in pixels")
        ->type_name("WxH")
        ->capture_default_str()
        ->check([](const std::string& text) {
            return sizeFrom(text) ? std::string() : "'" + text + "' " + kSizeForm;
        });
    app.add_option("--camera", options.camera,
                   "Eye and target in glTF coordinates, vertical degrees; default: the file's "
                   "first camera, else one that frames the scene")
        ->type_name("EX,EY,EZ,TX,TY,TZ[,FOVY]")
        ->check([](const std::string& text) {
            return cameraFrom(text) ? std::string() : "'" + text + "' " + kCameraForm;
        });
    app.add_option("--exposure", options.exposure, "Stops: .png holds radiance * 2^STOPS")
        ->type_name("STOPS")
        ->capture_default_str()
        ->check(CLI::Range(-40.0, 40.0));
}

Size parseSize(const std::string& text)
{
    const std::optional<Size> size = sizeFrom(text);
    if (!size)
        throw Error("--size: '" + text + "' " + kSizeForm);
    return *size;
}

Camera chooseCamera(const Scene& scene, const std::string& text)
{
    if (text.empty())
        return defaultCamera(scene);
    const std::optional<Camera> camera = cameraFrom(text);
    if (!camera)
        throw Error("--camera: '" + text + "' " + kCameraForm);
    return *camera;
}

void addJsonOption(CLI::App& app, std::string& path)
{
    app.add_option("--json", path, "Settings and results, for machines")->type_name("FILE");
}

void addExamples(CLI::App& app, const std::string& lines)
{
    app.footer("Examples:\n" + lines);
}

} // namespace strandlight::cli
