// The part of PbrtTranslator that writes lights.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "error.h"
#include "pbrt_spectra.h"
#include "pbrt_translator.h"
#include "radiance_map.h"

namespace vkvol {

namespace {

using std::numbers::pi;

glm::dvec3 moved(const glm::dmat4& map, const glm::dvec3& p) {
    return glm::dvec3(map * glm::dvec4(p, 1.0));
}

// Illuminance by a square map of what faces its z, as pbrt adds it up: a texel counts as 2 pi over their number, which
// is half of its solid angle, so that a map of given illuminance shines twice as bright there, and here.
double illuminance_of(const RadianceMap& map) {
    double sum = 0.0;
    for (int row = 0; row < map.height; ++row)
        for (int column = 0; column < map.width; ++column) {
            const double r =
                std::abs(2.0 * (column + 0.5) / map.width - 1.0) + std::abs(2.0 * (row + 0.5) / map.height - 1.0);
            const glm::dvec3 texel = map.texels[std::size_t(row) * map.width + column];
            // 1 - r^2 is the cosine.
            sum += r < 1.0 ? (1.0 - r * r) * glm::dot(texel, glm::dvec3(0.2126, 0.7152, 0.0722)) : 0.0;
        }
    return 2.0 * pi * sum / (double(map.width) * map.height);
}

} // namespace

// In the unit of the film, with the light's own scale.
glm::dvec3 PbrtTranslator::light_color(const PbrtThing& light, const char* name) {
    const glm::dvec3 color = colors_.light(light, name).value_or(white_of_space(light.color_space));
    return color * (light.parameters->number("scale", 1.0) * exposure_);
}

double PbrtTranslator::own_illuminance(const PbrtThing& light) const {
    double illuminance = 0.0;
    try {
        illuminance = illuminance_of(read_radiance_map(scene_.folder / light.parameters->text("filename")));
    } catch (const InputError& error) { // which names the file
        fail_at(light.place, error.what());
    }
    if (!(illuminance > 0.0))
        fail_at(light.place, "the upper half of its map is black, so that no \"scale\" gives it an \"illuminance\"; "
                             "leave that out");
    return illuminance;
}

void PbrtTranslator::write_sky(const PbrtThing& light) {
    const PbrtParameters& p = *light.parameters;
    double scale = p.number("scale", 1.0) * exposure_;
    if (const double illuminance = p.number("illuminance", -1.0); illuminance > 0.0)
        scale *= illuminance / own_illuminance(light);
    if (p.has("portal"))
        note(light.place, "\"portal\" is left out; the whole map shines");
    XmlAttributes attributes = {{"mapping", "equalArea"}, {"multiplier", xml_number(scale)}};
    if (sky_is_mirrored_)
        attributes.emplace_back("mirror", "true");
    xml_.element("sky", attributes, file_name(light), light.place.text());
}

void PbrtTranslator::write_light(const PbrtThing& light) {
    const PbrtParameters& p = *light.parameters;
    const glm::dmat4 map = world_ * light.transform;
    const glm::dvec3 from = p.point("from", glm::dvec3(0.0)), to = p.point("to", {0.0, 0.0, 1.0});
    XmlAttributes attributes;
    if (light.type == "distant") {
        if (from == to)
            fail_at(light.place, "LightSource \"distant\" has no direction; from and to are one point");
        add_xyz(attributes, glm::dmat3(map) * (from - to));
        const double illuminance = p.number("illuminance", -1.0);
        add_rgb(attributes, light_color(light, "L") * (illuminance > 0.0 ? illuminance : 1.0));
        xml_.element("directional", attributes, "", light.place.text());
        return;
    }
    glm::dvec3 intensity = light_color(light, "I");
    const double power = p.number("power", -1.0);
    add_xyz(attributes, moved(map, from));
    if (light.type == "point") {
        add_rgb(attributes, intensity * (power > 0.0 ? power / (4.0 * pi) : 1.0));
        xml_.element("point", attributes, "", light.place.text());
        return;
    }
    const double angle = p.number("coneangle", 30.0);
    double falls = p.number("conedeltaangle", 5.0);
    if (falls > angle && falls <= 2.0 * angle) // past the axis, and as far again on its other side
        falls = 2.0 * angle - falls;
    if (!(angle > 0.0) || angle > 90.0 || !(falls >= 0.0) || falls > angle)
        fail_at(light.place, fmt::format("a cone of {:g} degrees, {:g} of them its rim; expected at most 90, and a rim "
                                         "within",
                                         angle, falls));
    if (power > 0.0) {
        const double rim = std::cos(glm::radians(angle)), whole = std::cos(glm::radians(angle - falls));
        intensity *= power / (2.0 * pi * (1.0 - 0.5 * (whole + rim)));
    }
    attributes.emplace_back("lookAt", xml_numbers(moved(map, to)));
    attributes.emplace_back("angle", xml_number(2.0 * angle));
    attributes.emplace_back("blend", xml_number(falls / angle));
    add_rgb(attributes, intensity);
    xml_.element("spot", attributes, "", light.place.text());
}

void PbrtTranslator::write_lights() {
    glm::dvec3 background(0.0);
    std::string place; // of the last that it is of
    bool has_map = false;
    xml_.open("lights");
    for (const PbrtThing& light : scene_.lights) {
        const PbrtParameters& p = *light.parameters;
        const bool is_map = light.type == "infinite" && !p.text("filename").empty();
        if (light.type == "infinite" && !is_map) {
            const double illuminance = p.number("illuminance", -1.0);
            background += light_color(light, "L") * (illuminance > 0.0 ? illuminance / pi : 1.0);
            place = light.place.text();
        } else if (light.type == "infinite" && has_map) {
            note(light.place, "a second map of the sky is left out; put both into one");
        } else if (light.type == "infinite") {
            write_sky(light);
            has_map = true;
        } else if (light.type == "distant" || light.type == "point" || light.type == "spot") {
            write_light(light);
        } else {
            note(light.place, fmt::format("LightSource \"{}\" is left out", light.type));
            continue;
        }
        if (double scale; (light.type == "spot" || is_map) && !turns_alone(glm::dmat3(light.transform), scale))
            note(light.place, "it is stretched by its transform in pbrt, and not here");
        note_unused(light);
    }
    xml_.close();
    XmlAttributes attributes;
    add_rgb(attributes, background);
    if (background != glm::dvec3(0.0))
        xml_.element("backgroundColor", attributes, "", place);
}

} // namespace vkvol
