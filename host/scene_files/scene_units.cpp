// The part of SceneReader that reads in which units readings come.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "nearest_name.h"
#include "scene_facts.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

// What falls on a level plane from such a light, mu0 F0, is what readings are parts of: without it they mean nothing.
constexpr double least_cosine = 1e-6;

glm::dvec3* direction_of(Light& light) {
    if (DirectionalLight* const beam = std::get_if<DirectionalLight>(&light))
        return &beam->direction;
    if (SunLight* const sun = std::get_if<SunLight>(&light))
        return &sun->direction;
    return nullptr;
}

Rgb& irradiance_of(Light& light) {
    if (DirectionalLight* const beam = std::get_if<DirectionalLight>(&light))
        return beam->irradiance;
    return std::get<SunLight>(light).irradiance;
}

} // namespace

// Relative to the one light there is: that has then the irradiance that makes readings what is asked for, in each
// channel 1 / mu0 for fluxes and powers, E / (mu0 F0), and pi / mu0 for radiances, pi I / (mu0 F0).
void SceneReader::read_units(Scene& scene) const {
    const XmlElement units = one("units");
    units.allow({}, true);
    const std::string name = units.text();
    if (!units.exists() || name == "radiance")
        return;
    if (name != "reflectance" && name != "transmittance")
        units.fail_text(
            fmt::format("unknown units '{}'{}", name, name_hint(name, {"radiance", "reflectance", "transmittance"})));
    if (scene.camera.projection == Projection::fluence)
        units.fail(fmt::format("<fluence> comes from all around, and is no {}; leave <units> out", name));
    const bool shines_otherwise = scene.background != Rgb(0.0) || emits(scene) ||
                                  std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                              [](const Surface& surface) { return surface.emission != Rgb(0.0); });
    const glm::dvec3* const direction = scene.lights.size() == 1 ? direction_of(scene.lights.front()) : nullptr;
    if (!direction || shines_otherwise)
        units.fail(fmt::format("<units> {} is relative to one light far away, <light>, or <directional> or <sun> in "
                               "<lights>, with nothing else that shines; leave the others out, or <units>",
                               name));
    scene.units = name;
    const double mu0 = std::abs(direction->y);
    if (mu0 < least_cosine)
        units.fail(fmt::format("<units> {} is relative to what falls on a level plane, and the light is level; raise "
                               "it, or leave <units> out",
                               name));
    if (const auto* sun = std::get_if<SunLight>(&scene.lights.front());
        sun && std::asin(mu0) < glm::radians(0.5 * sun->angle))
        units.fail(
            fmt::format("<units> {} is relative to what falls on a level plane, and the sun's disc is partly below "
                        "it; raise the sun, or give it a smaller angle, or leave <units> out",
                        name));
    // Channels without light have no such parts, and stay 0.
    for (int c = 0; c < 3; ++c)
        if (double& irradiance = irradiance_of(scene.lights.front())[c]; irradiance > 0.0)
            irradiance = (reads_flux(scene.camera) ? 1.0 : std::numbers::pi) / mu0;
}

} // namespace vkvol
