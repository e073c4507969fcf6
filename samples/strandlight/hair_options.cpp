#include "samples/strandlight/hair_options.hpp"

#include <cmath>

#include "engine/base/error.hpp"
#include "engine/scene/grooms.hpp"
#include "engine/scene/hair_head.hpp"
#include "engine/scene/hair_loader.hpp"

namespace strandlight::cli {

namespace {

const std::string kBuiltin = "builtin:";

template <class T> void choose(T& value, const std::optional<T>& given)
{
    if (given)
        value = *given;
}

HairStrands openGroom(const std::string& name, const GroomOptions& o)
{
    GroomSettings settings = groomSettings(name);
    choose(settings.strands, o.strands);
    choose(settings.segments, o.segments);
    choose(settings.lengthMetres, o.length);
    choose(settings.clumping, o.clumping);
    choose(settings.frizz, o.frizz);
    choose(settings.colorVariation, o.colorVariation);
    choose(settings.seed, o.seed);
    return makeGroom(name, settings);
}

HairStrands openFile(const std::string& path, const GroomOptions& o)
{
    if (o.segments || o.length || o.clumping || o.frizz)
        throw Error(
            "--segments, --length, --clumping and --frizz are for builtin grooms, not for " + path);
    HairDefaults defaults;
    choose(defaults.colorVariation, o.colorVariation);
    choose(defaults.seed, o.seed);
    const HairStrands strands = loadHair(path, defaults);
    return o.strands ? selectStrands(strands, *o.strands) : strands;
}

glm::vec3 parseOffset(const std::string& text)
{
    const std::vector<std::string> parts = CLI::detail::split(text, ',');
    glm::vec3 offset(0.0f);
    bool good = parts.size() == 3;
    for (int c = 0; good && c < 3; ++c)
        good = CLI::detail::lexical_cast(parts[std::size_t(c)], offset[c]) &&
               std::abs(offset[c]) <= 1e4f;
    if (!good)
        throw Error("--hair-offset: '" + text + "' is not X,Y,Z in metres");
    return offset;
}

template <class T>
void addGiven(CLI::App& app, const std::string& name, std::optional<T>& value,
              const std::string& meaning, T lowest, T highest)
{
    app.add_option(name, value, meaning)->type_name("N")->check(CLI::Range(lowest, highest));
}

} // namespace

void addHairOptions(CLI::App& app, HairOptions& o)
{
    std::string grooms;
    for (const std::string& name : groomNames())
        grooms += (grooms.empty() ? "" : "|") + name;
    app.add_option("HAIR", o.hair, ".tfx, .hair or builtin:" + grooms)->required()->type_name("");
    app.add_option("--scene", o.scene, "What hides and lights the hair; default: a head for grooms")
        ->type_name("SCENE");
    app.add_option("--bake", o.bake, "Of that scene, .sgl: lights the hair, and is behind it")
        ->type_name("FILE");
    app.add_option("--env", o.environment, "Distant environment, lat-long .hdr or .exr")
        ->type_name("FILE");
    app.add_option("--hair-scale", o.scale, "Factor on the hair's size, widths too")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(1e-3f, 1e3f));
    app.add_option("--hair-offset", o.offset,
                   "Then moved by; default: onto the head of builtin:bust, else not at all")
        ->type_name("X,Y,Z");
    addGiven(app, "--strands", o.groom.strands, "So many", 1u, kMostGroomStrands);
    addGiven(app, "--segments", o.groom.segments, "Of a groom's strand", 1u, kMostGroomSegments);
    addGiven(app, "--length", o.groom.length, "Of a groom in metres", 0.005f, 2.0f);
    addGiven(app, "--clumping", o.groom.clumping, "Of a groom's locks", 0.0f, 1.0f);
    addGiven(app, "--frizz", o.groom.frizz, "Of a groom", 0.0f, 1.0f);
    addGiven(app, "--color-variation", o.groom.colorVariation, "By strand and along it", 0.0f,
             1.0f);
    app.add_option("--width", o.width, "Factor on the width of all strands")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0.01f, 100.0f));
    addGiven(app, "--seed", o.groom.seed, "Of groom and colours", 0u, ~0u);
}

bool isGroom(const HairOptions& o)
{
    return o.hair.starts_with(kBuiltin);
}

HairStrands openHair(const HairOptions& o)
{
    HairStrands strands =
        isGroom(o) ? openGroom(o.hair.substr(kBuiltin.size()), o.groom) : openFile(o.hair, o.groom);
    const bool onBust = isGroom(o) && o.scene == "builtin:bust";
    const glm::vec3 offset = !o.offset.empty() ? parseOffset(o.offset)
                             : onBust          ? kBustPlace
                                               : glm::vec3(0.0f);
    for (float& radius : strands.radii)
        radius *= o.width * o.scale;
    for (glm::vec3& point : strands.points)
        point = point * o.scale + offset;
    return strands;
}

} // namespace strandlight::cli
