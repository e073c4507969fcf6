// strandlight info: devices, a scene or a bake.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "engine/base/error.hpp"
#include "engine/scene/atlas.hpp"
#include "engine/scene/camera.hpp"
#include "passes/sgl_file.hpp"
#include "samples/strandlight/commands.hpp"
#include "samples/strandlight/outputs.hpp"

namespace strandlight::cli {

namespace {

struct Options
{
    SceneOptions scene;
    std::uint32_t atlas = AtlasSettings{}.resolution;
    std::string json;
};

// --- devices --------------------------------------------------------------------------------

Json showDevices()
{
    Json json = Json::array();
    int index = 0;
    for (const DeviceInfo& device : Context::devices()) {
        std::printf("%d  %s (%s), %s: %s\n", index++, device.name.c_str(), device.type.c_str(),
                    device.driver.c_str(), device.refusals.empty() ? "usable" : "refused");
        for (const std::string& reason : device.refusals)
            std::printf("     lacks %s\n", reason.c_str());
        if (device.refusals.empty())
            std::printf(
                "     matrix units %s\n     half tensors %s%s\n", device.matrixUnits.c_str(),
                device.missingForHalves.empty() ? "usable" : "not usable: the device lacks ",
                device.missingForHalves.c_str());
        json.push_back({{"name", device.name},
                        {"driver", device.driver},
                        {"type", device.type},
                        {"usable", device.refusals.empty()},
                        {"matrix_units", device.matrixUnits},
                        {"missing_for_halves", device.missingForHalves},
                        {"refusals", device.refusals}});
    }
    if (json.empty())
        throw Error("no Vulkan device: install a driver, e.g. mesa-vulkan-drivers");
    return json;
}

// --- scenes ---------------------------------------------------------------------------------

std::string textureName(const TextureSlot& slot)
{
    return slot.texture < 0 ? "-" : std::to_string(slot.texture);
}

void showMaterials(const Scene& scene, Json& json)
{
    json["materials"] = Json::array();
    for (const Material& m : scene.materials) {
        std::printf("  %-24s colour %.3f %.3f %.3f, metallic %.2f, roughness %.2f", m.name.c_str(),
                    m.baseColor.r, m.baseColor.g, m.baseColor.b, m.metallic, m.roughness);
        const float emission = std::max({m.emissive.r, m.emissive.g, m.emissive.b});
        if (emission > 0.0f)
            std::printf(", emits %.3g %.3g %.3g", m.emissive.r, m.emissive.g, m.emissive.b);
        std::printf(", textures %s %s %s %s\n", textureName(m.baseColorTexture).c_str(),
                    textureName(m.metallicRoughnessTexture).c_str(),
                    textureName(m.normalTexture).c_str(), textureName(m.emissiveTexture).c_str());
        json["materials"].push_back({{"name", m.name},
                                     {"base_color", {m.baseColor.r, m.baseColor.g, m.baseColor.b}},
                                     {"metallic", m.metallic},
                                     {"roughness", m.roughness},
                                     {"emissive", {m.emissive.r, m.emissive.g, m.emissive.b}}});
    }
}

void showAtlas(const Scene& scene, std::uint32_t resolution, Json& json)
{
    AtlasSettings settings;
    settings.resolution = resolution;
    const Atlas atlas = buildAtlas(scene, settings);
    const char* source = atlas.usedTexCoord1  ? "TEXCOORD_1, a valid unique set"
                         : scene.hasTexCoord1 ? "own charts: TEXCOORD_1 overlaps or leaves [0,1]"
                                              : "own charts: no TEXCOORD_1";
    const double covered =
        double(atlas.texels.size()) / (double(atlas.resolution) * atlas.resolution);
    std::printf("atlas      %ux%u, %s; %u charts, %zu texels with surface (%.0f %%), %.2f texels "
                "per metre\n",
                atlas.resolution, atlas.resolution, source, atlas.chartCount, atlas.texels.size(),
                100.0 * covered, atlas.texelsPerMetre);
    json["atlas"] = {
        {"resolution", atlas.resolution},        {"texcoord1_present", scene.hasTexCoord1},
        {"texcoord1_used", atlas.usedTexCoord1}, {"charts", atlas.chartCount},
        {"texels", atlas.texels.size()},         {"texels_per_metre", atlas.texelsPerMetre}};
}

Json showScene(const Options& o)
{
    const Scene scene = openScene(o.scene);
    const glm::vec3 low = scene.boundsMin(), high = scene.boundsMax();
    const Camera camera = defaultCamera(scene);
    static const char* const kLightNames[] = {"point", "spot", "directional"};

    std::printf("scene      %s\n", scene.name.c_str());
    std::printf("geometry   %zu triangles, %zu vertices\n", scene.triangles.size(),
                scene.vertices.size());
    std::printf("bounds     %.3f %.3f %.3f to %.3f %.3f %.3f m\n", low.x, low.y, low.z, high.x,
                high.y, high.z);
    std::printf("camera     eye %.3f %.3f %.3f, target %.3f %.3f %.3f, %.1f degrees (%s)\n",
                camera.eye.x, camera.eye.y, camera.eye.z, camera.target.x, camera.target.y,
                camera.target.z, camera.verticalFovDegrees,
                scene.cameras.empty() ? "automatic" : "the first of the file");
    Json json = {{"name", scene.name},
                 {"triangles", scene.triangles.size()},
                 {"vertices", scene.vertices.size()},
                 {"textures", scene.textures.size()},
                 {"cameras", scene.cameras.size()},
                 {"bounds", {{low.x, low.y, low.z}, {high.x, high.y, high.z}}},
                 {"camera", describeCamera(camera)}};
    json["lights"] = Json::array();
    for (const PunctualLight& light : scene.lights) {
        const char* type = kLightNames[static_cast<int>(light.type)];
        std::printf("light      %s, intensity %.3g %.3g %.3g\n", type, light.intensity.r,
                    light.intensity.g, light.intensity.b);
        json["lights"].push_back(type);
    }
    if (scene.environment)
        std::printf("sky        %ux%u\n", scene.environment->latLong.width,
                    scene.environment->latLong.height);
    if (!scene.triangles.empty())
        showAtlas(scene, o.atlas, json);
    std::printf("textures   %zu\n", scene.textures.size());
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        std::printf("  %zu  %s, %ux%u\n", i, scene.textures[i].name.c_str(),
                    scene.textures[i].width, scene.textures[i].height);
    std::printf("materials  %zu (textures: colour, metallic-roughness, normal, emissive)\n",
                scene.materials.size());
    showMaterials(scene, json);
    return json;
}

// --- bakes ----------------------------------------------------------------------------------

Json showBake(const std::string& path)
{
    const SgBake bake = loadSgl(path);
    const BakeInfo& info = bake.info;
    const std::uint32_t environmentLobes = bake.environment ? bake.environment->lobeCount : 0;
    const std::uint64_t fileBytes = std::filesystem::file_size(path);
    const double bytesPerTexel =
        double(fileBytes) / double(std::max<std::size_t>(bake.atlas.texels.size(), 1));
    std::printf("bake       of %s\n", info.scene.c_str());
    std::printf("lobes      %u per texel, %u for the environment\n", bake.radiance.lobeCount,
                environmentLobes);
    std::printf("file       %s, %.1f bytes per texel, atlas included\n",
                bytesText(fileBytes).c_str(), bytesPerTexel);
    std::printf("atlas      %ux%u, %u charts, %zu texels, %s\n", bake.atlas.resolution,
                bake.atlas.resolution, bake.atlas.chartCount, bake.atlas.texels.size(),
                bake.atlas.usedTexCoord1 ? "TEXCOORD_1" : "own charts");
    std::printf("capture    %ux%u directions, %u paths each, %u bounces, seed %u\n",
                info.lightfieldSize, info.lightfieldSize, info.samplesPerDirection, info.bounces,
                info.seed);
    std::printf("fit        %s, %u steps, light field RMSE %.4g\n", info.fitMode.c_str(),
                info.steps, info.rmse);
    return {{"scene", info.scene},
            {"lobes", bake.radiance.lobeCount},
            {"environment_lobes", environmentLobes},
            {"file_bytes", fileBytes},
            {"bytes_per_texel", bytesPerTexel},
            {"atlas", bake.atlas.resolution},
            {"charts", bake.atlas.chartCount},
            {"texels", bake.atlas.texels.size()},
            {"lightfield", info.lightfieldSize},
            {"spp", info.samplesPerDirection},
            {"bounces", info.bounces},
            {"seed", info.seed},
            {"fit", info.fitMode},
            {"steps", info.steps},
            {"radiance_rmse", info.rmse}};
}

int run(const Options& o)
{
    requireOutput(o.json, {".json"});
    Json json = describeRun("info", nullptr);
    if (o.scene.scene.empty())
        json["devices"] = showDevices();
    else if (o.scene.scene.ends_with(".sgl"))
        json["bake"] = showBake(o.scene.scene);
    else
        json["scene"] = showScene(o);
    writeJson(o.json, json);
    return 0;
}

} // namespace

Command addInfo(CLI::App& parent)
{
    CLI::App* app = parent.add_subcommand("info", "Show the devices, a scene or a bake");
    const auto o = std::make_shared<Options>();
    app->add_option("FILE", o->scene.scene, "A scene or a .sgl; without: the Vulkan devices")
        ->type_name("");
    app->add_option("--env", o->scene.environment, "Distant environment, .hdr or .exr")
        ->type_name("FILE");
    app->add_option("--atlas", o->atlas, "Texels per side to try the atlas with")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(8u, 4096u));
    addJsonOption(*app, o->json);
    addExamples(*app, "  strandlight info\n"
                      "  strandlight info builtin:room\n"
                      "  strandlight info room.sgl --json room.json");
    return {app, [o] { return run(*o); }};
}

} // namespace strandlight::cli
