// The part of SceneReader that reads <lights>.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "blackbody.h"
#include "daylight.h"
#include "scene_places.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

const std::vector<std::string> light_kinds = {"directional", "sun",       "point", "spot",    "sphere",
                                              "disk",        "rectangle", "sky",   "daylight"};
const std::vector<std::string> light_colors = {"r", "g", "b", "kelvin", "multiplier", "group"};
constexpr Limits part{0.0, 1.0, true, true, "a number from 0 to 1"};
constexpr Limits flame{500.0, 40000.0, true, true, "a temperature from 500 to 40000 kelvin"};

std::vector<std::string> with_colors(std::vector<std::string> attributes) {
    attributes.insert(attributes.end(), light_colors.begin(), light_colors.end());
    return attributes;
}

RectangleLight rectangle_light(const XmlElement& element, const Rgb& radiance) {
    const Rectangle shape = rectangle(element);
    return {shape.center, shape.edge_u, shape.edge_v, radiance};
}

SkyMapping sky_mapping(const XmlElement& element) {
    const std::string name = element.attribute("mapping", "equirectangular");
    if (name == "equalArea")
        return SkyMapping::equal_area;
    if (name != "equirectangular")
        element.fail_attribute(
            "mapping", fmt::format("<sky> mapping: '{}' is unknown; expected equirectangular or equalArea", name));
    return SkyMapping::equirectangular;
}

// The camera may see it.
void check_disc(const XmlElement& element, const SunLight& sun) {
    const Rgb peak = peak_radiance(sun);
    const double radiance = std::max({peak.x, peak.y, peak.z});
    if (radiance > brightest_light)
        element.fail_attribute("angle", fmt::format("<sun> angle: a disc of {:g} degrees and of this irradiance has a "
                                                    "radiance of {:.3g}, but {:g} is the most; widen or dim it",
                                                    sun.angle, radiance, brightest_light));
}

} // namespace

// By r, g and b, or by the temperature of a black body, of luminance 1; white without any of these. Each times
// multiplier.
Rgb SceneReader::light_color(const XmlElement& element) const {
    const bool mixed = element.has("r") || element.has("g") || element.has("b");
    if (mixed && element.has("kelvin"))
        element.fail_attribute(
            "kelvin",
            fmt::format("<{}> kelvin: r, g and b say its colour already; remove one of them", element.name()));
    if (mixed)
        return color(element);
    const double kelvin = element.attribute_number("kelvin", 6500.0, flame);
    const Rgb tint = (element.has("kelvin") ? blackbody_rgb(kelvin, kelvin) : Rgb(1.0)) *
                     element.attribute_number("multiplier", 1.0, not_negative);
    if (std::max({tint.x, tint.y, tint.z}) > brightest_light)
        element.fail_attribute("multiplier", fmt::format("<{}> multiplier: {:g} is the most that a colour may come to; "
                                                         "lower it",
                                                         element.name(), brightest_light));
    return tint;
}

// Where `power` is given in place of multiplier it is what the light sends out in all, times its colour.
template <class Kind> Light SceneReader::of_power(const XmlElement& element, Kind light, Rgb Kind::*shine) const {
    if (!element.has("power"))
        return light;
    if (element.has("multiplier"))
        element.fail_attribute(
            "power", fmt::format("<{}> power: multiplier says how bright it is; remove one of them", element.name()));
    Rgb& color = light.*shine;
    color *= element.attribute_number("power", 1.0, not_negative) / power_per_unit(light);
    if (std::max({color.x, color.y, color.z}) > brightest_light)
        element.fail_attribute("power",
                               fmt::format("<{}> power: comes to {:.3g} from so small a light, but {:g} is the most; "
                                           "lower it, or widen the light",
                                           element.name(), std::max({color.x, color.y, color.z}), brightest_light));
    return light;
}

Light SceneReader::light(const XmlElement& element) const {
    const std::string kind = element.name();
    if (kind == "directional") {
        element.allow(with_colors({"x", "y", "z", "zenith", "azimuth"}));
        return DirectionalLight{direction_towards(element), light_color(element)};
    }
    if (kind == "sun") {
        element.allow(with_colors({"x", "y", "z", "zenith", "azimuth", "angle", "limbDarkening"}));
        SunLight sun{direction_towards(element), light_color(element)};
        sun.angle = element.attribute_number("angle", sun.angle,
                                             {0.01, 180.0, true, true, "an angle from 0.01 to 180 degrees"});
        sun.limb_darkening = element.attribute_number("limbDarkening", sun.limb_darkening, part);
        check_disc(element, sun);
        return sun;
    }
    if (kind == "point") {
        element.allow(with_colors({"x", "y", "z", "power"}));
        return of_power(element, PointLight{xyz(element, coordinate), light_color(element)}, &PointLight::intensity);
    }
    if (kind == "spot") {
        element.allow(with_colors({"x", "y", "z", "lookAt", "angle", "blend", "power"}));
        SpotLight spot;
        spot.position = xyz(element, coordinate);
        spot.direction = looking_at(element, spot.position);
        spot.intensity = light_color(element);
        spot.angle =
            element.attribute_number("angle", spot.angle, {0.1, 180.0, true, true, "an angle from 0.1 to 180 degrees"});
        spot.blend = element.attribute_number("blend", spot.blend, part);
        return of_power(element, spot, &SpotLight::intensity);
    }
    if (kind == "sphere") {
        element.allow(with_colors({"x", "y", "z", "radius", "power"}));
        const double radius = element.attribute_number("radius", 1.0, length);
        return of_power(element, SphereLight{xyz(element, coordinate), radius, light_color(element)},
                        &SphereLight::radiance);
    }
    if (kind == "disk") {
        element.allow(with_colors({"x", "y", "z", "lookAt", "radius", "power"}));
        const glm::dvec3 center = xyz(element, coordinate);
        const double radius = element.attribute_number("radius", 1.0, length);
        return of_power(element, DiskLight{center, looking_at(element, center), radius, light_color(element)},
                        &DiskLight::radiance);
    }
    if (kind == "rectangle") {
        element.allow(with_colors({"x", "y", "z", "lookAt", "up", "width", "height", "power"}));
        return of_power(element, rectangle_light(element, light_color(element)), &RectangleLight::radiance);
    }
    element.allow(with_colors({"baseDir", "mapping", "rotation", "mirror"}), true);
    SkyLight sky;
    sky.mapping = sky_mapping(element);
    sky.file = file_path(element, "sky.exr");
    sky.place = element.place();
    sky.rotation = element.attribute_number("rotation", 0.0, any_number);
    sky.mirror = element.attribute_boolean("mirror", false);
    sky.scale = light_color(element);
    return sky;
}

// A sky, and the sun in it.
void SceneReader::read_daylight(const XmlElement& element, Scene& scene) const {
    element.allow({"x", "y", "z", "zenith", "azimuth", "turbidity", "ground", "multiplier", "group"});
    Daylight daylight;
    daylight.sun = direction_towards(element);
    if (daylight.sun.y <= 0.0)
        element.fail_attribute(element.has("zenith") ? "zenith" : "y",
                               "<daylight>: the sun is below the horizon; x, y, z point from the scene towards it, "
                               "and y is up");
    daylight.turbidity = element.attribute_number("turbidity", daylight.turbidity,
                                                  {2.0, 10.0, true, true, "a number from 2 (clear) to 10 (hazy)"});
    daylight.ground =
        element.attribute_number("ground", daylight.ground, {0.0, 1.0, true, true, "an albedo from 0 to 1"});
    SkyLight sky;
    sky.daylight = daylight;
    sky.scale = Rgb(element.attribute_number("multiplier", 1.0, {0.0, 1e5, true, true, "a number from 0 to 1e5"}));
    if (sky.scale == Rgb(0.0)) {
        scene.black.push_back({element.name(), element.place(), group_name(element), scene.lights.size()});
        return;
    }
    SunLight sun;
    sun.direction = daylight.sun;
    sun.irradiance = sky.scale * sun_irradiance(daylight);
    sky.group = sun.group = group_name(element);
    scene.lights.push_back(sky);
    scene.lights.push_back(sun);
}

void SceneReader::read_lights(Scene& scene) const {
    const XmlElement group = one("lights");
    group.allow({}, false, light_kinds);
    pugi::xml_node sky;
    for (const pugi::xml_node node : document_.root().child("lights").children()) {
        if (node.type() != pugi::node_element)
            continue;
        const XmlElement element(document_, node);
        const bool is_sky = element.name() == "sky" || element.name() == "daylight";
        if (is_sky && sky)
            element.fail(fmt::format("a second map of the sky, after the one at {}; remove one", document_.place(sky)));
        if (is_sky)
            sky = node;
        if (element.name() == "daylight") {
            read_daylight(element, scene);
            continue;
        }
        Light read = light(element);
        std::visit([&](auto& kind) { kind.group = group_name(element); }, read);
        const auto color_of = [](const auto& kind) {
            if constexpr (requires { kind.irradiance; })
                return kind.irradiance;
            else if constexpr (requires { kind.intensity; })
                return kind.intensity;
            else if constexpr (requires { kind.radiance; })
                return kind.radiance;
            else
                return kind.scale;
        };
        if (std::visit(color_of, read) == Rgb(0.0))
            scene.black.push_back({element.name(), element.place(), group_name(element), scene.lights.size()});
        else
            scene.lights.push_back(read);
    }
}

} // namespace vkvol
