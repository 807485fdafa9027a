// The part of SceneReader that reads the camera.
#include <cmath>
#include <fmt/format.h>

#include "camera_view.h"
#include "scene_places.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

const char* first_of(const XmlElement& element, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (element.has(name))
            return name;
    return nullptr;
}

// What belongs to lookAt, or against it.
void check_combination(const XmlElement& element) {
    if (!element.has("lookAt")) {
        if (const char* name = first_of(element, {"distance", "azimuth", "elevation", "up"}))
            element.fail_attribute(name, fmt::format("<camera> {}: has a meaning beside lookAt only; add "
                                                     "lookAt=\"x y z\", the point to look at",
                                                     name));
        return;
    }
    if (const char* name = first_of(element, {"pitch", "yaw", "roll"}))
        element.fail_attribute(name, fmt::format("<camera> {}: lookAt turns the camera already; remove one of them "
                                                 "(up=\"x y z\" tilts the picture)",
                                                 name));
    const char* orbit = first_of(element, {"distance", "azimuth", "elevation"});
    if (!orbit)
        return;
    if (const char* name = first_of(element, {"x", "y", "z"}))
        element.fail_attribute(name, fmt::format("<camera> {}: {} and lookAt say where the camera is; keep either x, "
                                                 "y, z or distance, azimuth, elevation",
                                                 name, orbit));
    if (!element.has("distance"))
        element.fail_attribute(orbit, fmt::format("<camera> {}: how far from lookAt? add distance=\"...\"", orbit));
}

glm::dvec3 up_of(const XmlElement& element) {
    const glm::dvec3 up = element.has("up") ? triple(element, "up", any_number) : glm::dvec3(0.0, 1.0, 0.0);
    if (up == glm::dvec3(0.0))
        element.fail_attribute("up", "<camera> up: has no direction; expected e.g. up=\"0 1 0\"");
    return up;
}

void look_at(const XmlElement& element, Camera& camera) {
    const glm::dvec3 target = triple(element, "lookAt", coordinate), up = up_of(element);
    if (element.has("distance")) {
        Orbit orbit{target, 0.0, 0.0, 0.0, up};
        orbit.distance = element.attribute_number("distance", 0.0, length);
        orbit.azimuth = element.attribute_number("azimuth", 0.0, any_number);
        orbit.elevation =
            element.attribute_number("elevation", 0.0, {-90, 90, true, true, "an angle from -90 to 90 degrees"});
        return place_on_orbit(camera, orbit);
    }
    const glm::dvec3 forward = target - camera.position;
    if (forward == glm::dvec3(0.0))
        element.fail_attribute("lookAt", "<camera> lookAt: is where the camera is; move one of them, or give distance, "
                                         "azimuth and elevation in place of x, y, z");
    if (is_parallel(forward, up))
        element.fail_attribute(element.has("up") ? "up" : "lookAt",
                               fmt::format("<camera> {}: the camera looks along {}, so that the picture could be "
                                           "turned any way; give another up, e.g. up=\"{}\"",
                                           element.has("up") ? "up" : "lookAt", element.has("up") ? "it" : "up (y)",
                                           std::abs(up.z) > std::abs(up.y) ? "0 1 0" : "0 0 -1"));
    look_along(camera, forward, up);
}

Projection projection_of(const XmlElement& element) {
    const std::string name = element.attribute("projection", "perspective");
    const Projection projection = name == "orthographic"      ? Projection::orthographic
                                  : name == "equirectangular" ? Projection::equirectangular
                                                              : Projection::perspective;
    if (projection == Projection::perspective && name != "perspective")
        element.fail_attribute("projection", fmt::format("<camera> projection: '{}' is unknown; expected perspective, "
                                                         "orthographic or equirectangular",
                                                         name));
    const char* instead = projection == Projection::perspective    ? "fov says how wide the view is"
                          : projection == Projection::orthographic ? "viewHeight says how much of the world is in view"
                                                                   : "all directions are in view";
    const auto refuse = [&](std::initializer_list<const char*> names, const char* remedy) {
        if (const char* found = first_of(element, names))
            element.fail_attribute(
                found, fmt::format("<camera> {}: has no meaning with projection=\"{}\"; {}", found, name, remedy));
    };
    if (projection != Projection::perspective) {
        refuse({"lensRadius", "focus", "blades", "bladeRotation"}, "only perspective cameras have a lens");
        refuse({"fov"}, instead);
    }
    if (projection != Projection::orthographic)
        refuse({"viewHeight"}, instead);
    return projection;
}

// `moves`: at other times an attribute may have another value.
Lens lens_of(const XmlElement& element, const Camera& camera, bool moves) {
    Lens lens;
    lens.radius = element.attribute_number("lensRadius", 0.0, {0.0, largest_length, true, true, "a number from 0"});
    const double focus = element.attribute_number("focus", 0.0, length);
    lens.blades = static_cast<int>(element.attribute_integer("blades", 0, 0, 100));
    if (lens.blades == 1 || lens.blades == 2)
        element.fail_attribute("blades",
                               "<camera> blades: fewer than three make no aperture; expected 3 to 100, or 0 for "
                               "a round one");
    lens.rotation = element.attribute_number("bladeRotation", 0.0, any_number);
    if (lens.radius == 0.0) {
        const bool may_open = moves && element.has("lensRadius");
        if (const char* name = first_of(element, {"focus", "blades", "bladeRotation"}); name && !may_open)
            element.warn(fmt::format("{} is without effect on a pinhole; add lensRadius, in world units", name));
        return {};
    }
    if (element.has("focus"))
        lens.focus = focus;
    else if (element.has("lookAt"))
        lens.focus = glm::dot(triple(element, "lookAt", coordinate) - camera.position, -camera_rotation(camera)[2]);
    else
        element.fail_attribute("lensRadius",
                               "<camera> lensRadius: what is sharp? add focus, the distance along the view, "
                               "or lookAt, the point that is");
    if (lens.radius > widest_lens * lens.focus)
        element.fail_attribute("lensRadius",
                               fmt::format("<camera> lensRadius: {:g} is more than {:g} times the distance of what is "
                                           "sharp, {:g}; lower it, or raise focus",
                                           lens.radius, widest_lens, lens.focus));
    return lens;
}

// By time and f-number, which go together.
std::optional<Exposure> exposure_of(const XmlElement& element) {
    constexpr Limits setting{1e-9, 1e9, true, true, "a number > 0, from 1e-9 to 1e9"};
    const char* said = first_of(element, {"shutter", "fNumber", "iso", "luminanceUnit"});
    if (!said)
        return std::nullopt;
    for (const char* needed : {"shutter", "fNumber"})
        if (!element.has(needed))
            element.fail_attribute(said, fmt::format("<camera> {}: an exposure is of shutter, in seconds, and fNumber; "
                                                     "add {}=\"...\"",
                                                     said, needed));
    Exposure exposure;
    exposure.shutter = element.attribute_number("shutter", 0.0, setting);
    exposure.f_number = element.attribute_number("fNumber", 0.0, setting);
    exposure.iso = element.attribute_number("iso", exposure.iso, setting);
    exposure.luminance_unit = element.attribute_number("luminanceUnit", exposure.luminance_unit, setting);
    if (const double stops = stops_of(exposure); std::abs(stops) > 100.0)
        element.fail_attribute(said, fmt::format("<camera> {}: the exposure comes to {:.3g} stops, beyond 100; check "
                                                 "shutter, fNumber, iso and luminanceUnit",
                                                 said, stops));
    return exposure;
}

} // namespace

// What the picture is taken by.
Camera SceneReader::sensor() const {
    XmlElement found(document_, {});
    for (const char* name : {"camera", "irradiance", "fluence", "absorption"}) {
        const XmlElement element = one(name);
        if (!element.exists())
            continue;
        if (found.exists())
            element.fail(fmt::format("a <{}> beside the <{}> at {}; a picture is taken by one of them: remove the "
                                     "other",
                                     name, found.name(), found.place()));
        found = element;
    }
    if (found.exists() && found.name() == "irradiance")
        return irradiance(found);
    if (found.exists() && found.name() == "fluence")
        return fluence(found);
    if (found.exists() && found.name() == "absorption")
        return absorption(found);
    return camera();
}

Camera SceneReader::camera() const {
    const XmlElement element = one("camera");
    element.allow({"x",          "y",          "z",          "pitch",        "yaw",     "roll",
                   "fov",        "lookAt",     "up",         "distance",     "azimuth", "elevation",
                   "projection", "viewHeight", "lensRadius", "focus",        "blades",  "bladeRotation",
                   "iso",        "shutter",    "fNumber",    "luminanceUnit"});
    const auto number = [&](const char* name, const Limits& limits) {
        return element.attribute_number(name, 0.0, limits);
    };
    Camera camera;
    camera.projection = projection_of(element);
    camera.view_height = element.attribute_number("viewHeight", camera.view_height, length);
    camera.position = {number("x", coordinate), number("y", coordinate), number("z", coordinate)};
    camera.pitch = number("pitch", any_number);
    camera.yaw = number("yaw", any_number);
    camera.roll = number("roll", any_number);
    camera.fov = element.attribute_number("fov", camera.fov,
                                          {0, 180, false, false, "an angle between 0 and 180 degrees, both excluded"});
    if (camera.fov < narrowest_fov || camera.fov > widest_fov)
        element.fail_attribute("fov",
                               fmt::format("<camera> fov: {:g} cannot be told from 0 or 180 in single precision; "
                                           "expected an angle from {:g} to {:.4f}",
                                           camera.fov, narrowest_fov, widest_fov));
    check_combination(element);
    if (element.has("lookAt"))
        look_at(element, camera);
    camera.lens = lens_of(element, camera, document_.moves());
    camera.exposure = exposure_of(element);
    return camera;
}

} // namespace vkvol
