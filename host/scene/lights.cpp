#include "lights.h"

#include <cmath>
#include <numbers>

namespace vkvol {

using std::numbers::pi;

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
