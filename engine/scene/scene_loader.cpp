#include "engine/scene/scene_loader.hpp"

#include <charconv>
#include <string_view>

#include "engine/base/error.hpp"
#include "engine/scene/gltf_loader.hpp"
#include "engine/scene/hair_head.hpp"
#include "engine/scene/procedural.hpp"

namespace strandlight {

namespace {

constexpr std::string_view kPrefix = "builtin:";
constexpr std::string_view kFurnace = "furnace";

Scene buildFurnace(std::string_view argument)
{
    if (argument.empty())
        return buildFurnaceScene(0.5f);
    argument.remove_prefix(1); // the colon
    float albedo = 0.0f;
    const auto [end, error] =
        std::from_chars(argument.data(), argument.data() + argument.size(), albedo);
    if (error != std::errc() || end != argument.data() + argument.size())
        throw Error("builtin:furnace: '" + std::string(argument) + "' is not a number");
    return buildFurnaceScene(albedo);
}

} // namespace

Scene loadScene(const std::string& pathOrBuiltin)
{
    if (!std::string_view(pathOrBuiltin).starts_with(kPrefix))
        return loadGltf(pathOrBuiltin);
    const std::string_view name = std::string_view(pathOrBuiltin).substr(kPrefix.size());
    if (name == "room")
        return buildRoomScene();
    if (name == "bust")
        return buildBustScene();
    if (name == "empty")
        return buildEmptyScene();
    if (name == "box")
        return buildDarkBoxScene();
    if (name == kFurnace || name.starts_with("furnace:"))
        return buildFurnace(name.substr(kFurnace.size()));
    throw Error("'" + pathOrBuiltin +
                "' is not a built-in scene: there are builtin:room, builtin:bust, "
                "builtin:furnace[:albedo], builtin:box and builtin:empty");
}

} // namespace strandlight
