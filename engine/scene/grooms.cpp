#include "engine/scene/grooms.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/error.hpp"
#include "engine/scene/grooms_growth.hpp"

namespace strandlight {

namespace {

struct Style
{
    const char* name;
    GroomShape shape;
    GroomSettings settings;
};

Style straight()
{
    Style s{"straight", {}, {}};
    s.shape.lift = 0.5f;
    s.shape.gravity = 40.0f;
    s.settings.lengthMetres = 0.35f;
    s.settings.frizz = 0.04f;
    s.settings.color = {0.75f, 0.52f, 0.28f};
    return s;
}

Style wavy()
{
    Style s{"wavy", {}, {}};
    s.shape.lift = 0.6f;
    s.shape.gravity = 30.0f;
    s.shape.curlTilt = 0.55f;
    s.shape.curlPitch = 0.09f;
    s.shape.isFlat = true;
    s.settings.lengthMetres = 0.35f;
    s.settings.clumping = 0.6f;
    s.settings.frizz = 0.1f;
    s.settings.color = {0.35f, 0.18f, 0.09f};
    return s;
}

Style curly()
{
    Style s{"curly", {}, {}};
    s.shape.lift = 1.0f;
    s.shape.gravity = 18.0f;
    s.shape.curlTilt = 0.95f;
    s.shape.curlPitch = 0.05f;
    s.settings.segments = 32;
    s.settings.lengthMetres = 0.36f;
    s.settings.clumping = 0.7f;
    s.settings.frizz = 0.15f;
    s.settings.color = {0.28f, 0.12f, 0.05f};
    return s;
}

Style afro()
{
    Style s{"afro", {}, {}};
    s.shape.lift = 4.0f;
    s.shape.gravity = 0.0f;
    s.shape.curlTilt = 1.0f;
    s.shape.curlPitch = 0.022f;
    s.settings.segments = 24;
    s.settings.lengthMetres = 0.15f;
    s.settings.clumping = 0.1f;
    s.settings.frizz = 0.6f;
    s.settings.color = {0.1f, 0.065f, 0.045f};
    return s;
}

Style ponytail()
{
    Style s{"ponytail", {}, {}};
    s.shape.lift = 0.25f;
    s.shape.gravity = 30.0f;
    s.shape.isTied = true;
    s.settings.segments = 24;
    s.settings.lengthMetres = 0.45f;
    s.settings.clumping = 0.0f;
    s.settings.frizz = 0.06f;
    s.settings.color = {0.5f, 0.2f, 0.08f};
    return s;
}

Style shortCut()
{
    Style s{"short", {}, {}};
    s.shape.lift = 1.5f;
    s.shape.gravity = 12.0f;
    s.settings.segments = 8;
    s.settings.lengthMetres = 0.035f;
    s.settings.lengthVariation = 0.4f;
    s.settings.clumping = 0.3f;
    s.settings.frizz = 0.25f;
    s.settings.color = {0.2f, 0.13f, 0.08f};
    return s;
}

const std::vector<Style>& styles()
{
    static const std::vector<Style> all = {straight(), wavy(),     curly(),
                                           afro(),     ponytail(), shortCut()};
    return all;
}

const Style& findStyle(const std::string& name)
{
    for (const Style& style : styles())
        if (name == style.name)
            return style;
    std::string known;
    for (const Style& style : styles())
        known += std::string(known.empty() ? "" : ", ") + style.name;
    throw Error("'" + name + "' is not a groom: " + known);
}

// Refuses NaN as well.
void requireRange(const char* what, float value, float low, float high)
{
    if (value >= low && value <= high)
        return;
    std::ostringstream text;
    text << "groom: " << what << " of " << value << " is outside of " << low << " .. " << high;
    throw Error(text.str());
}

void check(const GroomSettings& s)
{
    if (s.strands == 0 || s.strands > kMostGroomStrands)
        throw Error("groom: " + std::to_string(s.strands) + " strands are outside of 1 .. " +
                    std::to_string(kMostGroomStrands));
    if (s.segments == 0 || s.segments > kMostGroomSegments)
        throw Error("groom: " + std::to_string(s.segments) + " segments are outside of 1 .. " +
                    std::to_string(kMostGroomSegments));
    requireRange("a length", s.lengthMetres, 0.005f, 2.0f);
    requireRange("a length variation", s.lengthVariation, 0.0f, 0.9f);
    requireRange("a radius", s.radiusMetres, 1e-6f, 1e-2f);
    requireRange("clumping", s.clumping, 0.0f, 1.0f);
    requireRange("frizz", s.frizz, 0.0f, 1.0f);
    requireRange("a colour variation", s.colorVariation, 0.0f, 1.0f);
    for (int c = 0; c < 3; ++c)
        requireRange("a colour", s.color[c], 0.0f, 1.0f);
}

} // namespace

const std::vector<std::string>& groomNames()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Style& style : styles())
            all.push_back(style.name);
        return all;
    }();
    return names;
}

GroomSettings groomSettings(const std::string& name)
{
    return findStyle(name).settings;
}

HairStrands makeGroom(const std::string& name, const GroomSettings& settings)
{
    const Style& style = findStyle(name);
    check(settings);
    HairStrands hair;
    hair.name = name;
    const std::uint32_t perStrand = settings.segments + 1;
    hair.points.resize(std::size_t(settings.strands) * perStrand);
    growStrands(style.shape, settings, hair.points);
    hair.radii.resize(hair.points.size());
    for (std::size_t i = 0; i < hair.radii.size(); ++i)
        hair.radii[i] = settings.radiusMetres *
                        tipTaper(float(i % perStrand) / static_cast<float>(settings.segments));
    for (std::uint32_t s = 0; s <= settings.strands; ++s)
        hair.firstPoint.push_back(s * perStrand);
    paintHair(hair, settings.color, settings.colorVariation, settings.seed);
    return hair;
}

} // namespace strandlight
