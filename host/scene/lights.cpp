#include "lights.h"

#include <cmath>
#include <numbers>

namespace vkvol {

using std::numbers::pi;

namespace {

struct Kind {
    const char* operator()(const DirectionalLight&) const { return "directional"; }
    const char* operator()(const SunLight&) const { return "sun"; }
    const char* operator()(const PointLight&) const { return "point"; }
    const char* operator()(const SpotLight&) const { return "spot"; }
    const char* operator()(const SkyLight& sky) const { return sky.daylight ? "daylight" : "sky"; }
    const char* operator()(const SphereLight&) const { return "sphere"; }
    const char* operator()(const DiskLight&) const { return "disk"; }
    const char* operator()(const RectangleLight&) const { return "rectangle"; }
    const char* operator()(const SurfaceLight&) const { return "surface"; }
    const char* operator()(const GlowLight&) const { return "medium"; }
};

} // namespace

const char* kind_of(const Light& light) {
    return std::visit(Kind{}, light);
}

std::optional<glm::dvec3> place_of(const Light& light) {
    if (const auto* point = std::get_if<PointLight>(&light))
        return point->position;
    if (const auto* spot = std::get_if<SpotLight>(&light))
        return spot->position;
    if (const auto* sphere = std::get_if<SphereLight>(&light))
        return sphere->center;
    if (const auto* disk = std::get_if<DiskLight>(&light))
        return disk->center;
    if (const auto* rectangle = std::get_if<RectangleLight>(&light))
        return rectangle->center;
    return std::nullopt;
}

// The irradiance of a disc of half angle a is the integral of I cos(t) over directions, which is pi sin^2(a) times that
// of I over s = (sin(t) / sin(a))^2 in [0, 1]; and the mean of mu = sqrt(1 - s) is 2/3.
Rgb peak_radiance(const SunLight& sun) {
    const double sine = std::sin(0.5 * sun.angle * pi / 180.0);
    return sun.irradiance / (pi * sine * sine * (1.0 - sun.limb_darkening / 3.0));
}

double power_per_unit(const PointLight&) {
    return 4.0 * pi;
}

// A cap's solid angle is 2 pi (1 - cos), and a smooth step of the cosine is one half on average.
double power_per_unit(const SpotLight& light) {
    const auto versine = [](double degrees) {
        const double s = std::sin(0.5 * degrees * pi / 180.0);
        return 2.0 * s * s;
    };
    return pi * (versine(0.5 * light.angle * (1.0 - light.blend)) + versine(0.5 * light.angle));
}

double power_per_unit(const SphereLight& light) {
    return 4.0 * pi * pi * light.radius * light.radius;
}

double power_per_unit(const DiskLight& light) {
    return pi * pi * light.radius * light.radius;
}

double power_per_unit(const RectangleLight& light) {
    return 4.0 * pi * glm::length(light.edge_u) * glm::length(light.edge_v);
}

} // namespace vkvol
