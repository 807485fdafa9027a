#include "scene_places.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkvol {

glm::dvec3 unit(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return glm::normalize(v / largest);
}

glm::dvec3 xyz(const XmlElement& element, const Limits& limits) {
    return {element.attribute_number("x", 0.0, limits), element.attribute_number("y", 0.0, limits),
            element.attribute_number("z", 0.0, limits)};
}

glm::dvec3 triple(const XmlElement& element, const char* name, const Limits& limits) {
    const std::vector<double> numbers = element.attribute_numbers(name, limits);
    if (numbers.size() != 3)
        element.fail_attribute(
            name, fmt::format("<{}> {}: expected three numbers x y z, e.g. {}=\"0 1 0\"", element.name(), name, name));
    return {numbers[0], numbers[1], numbers[2]};
}

glm::dvec3 direction_towards(const XmlElement& element) {
    if (element.has("zenith") || element.has("azimuth")) {
        for (const char* name : {"x", "y", "z"})
            if (element.has(name))
                element.fail_attribute(name,
                                       fmt::format("<{}> {}: zenith and azimuth say the direction already; remove "
                                                   "them, or x, y and z",
                                                   element.name(), name));
        const double zenith = glm::radians(
            element.attribute_number("zenith", 0.0, {0.0, 180.0, true, true, "an angle from 0 to 180 degrees"}));
        const double azimuth = glm::radians(element.attribute_number("azimuth", 0.0, any_number));
        return {std::sin(zenith) * std::sin(azimuth), std::cos(zenith), std::sin(zenith) * std::cos(azimuth)};
    }
    const glm::dvec3 towards = xyz(element, any_number);
    if (towards == glm::dvec3(0.0))
        element.fail(fmt::format("<{}> has no direction; x, y, z point from the scene towards the light, e.g. x=\"0\" "
                                 "y=\"1\" z=\"0\", or zenith=\"30\" azimuth=\"0\"",
                                 element.name()));
    return unit(towards);
}

glm::dvec3 looking_at(const XmlElement& element, const glm::dvec3& position) {
    const std::vector<double> numbers = element.attribute_numbers("lookAt", coordinate);
    if (numbers.size() != 3)
        element.fail(fmt::format("<{}> needs lookAt=\"x y z\", the point that it faces", element.name()));
    const glm::dvec3 target(numbers[0], numbers[1], numbers[2]);
    if (target == position)
        element.fail_attribute("lookAt",
                               fmt::format("<{}> lookAt: is where its middle is; move one of them", element.name()));
    return unit(target - position);
}

glm::dmat3 axes_facing(const XmlElement& element, const glm::dvec3& normal) {
    glm::dvec3 up = std::abs(normal.y) < 0.999 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
    if (element.has("up")) {
        up = triple(element, "up", any_number);
        if (up == glm::dvec3(0.0))
            element.fail_attribute(
                "up", fmt::format("<{}> up: expected a direction x y z, e.g. up=\"0 1 0\"", element.name()));
        up = unit(up);
    }
    const glm::dvec3 across = glm::cross(normal, up);
    if (glm::length(across) < 1e-6)
        element.fail_attribute(element.has("up") ? "up" : "lookAt",
                               fmt::format("<{}> up: is the direction that it faces; name another", element.name()));
    return {-glm::normalize(across), glm::normalize(glm::cross(glm::normalize(across), normal)), normal};
}

Rectangle rectangle(const XmlElement& element) {
    Rectangle shape;
    shape.center = xyz(element, coordinate);
    const glm::dmat3 axes = axes_facing(element, looking_at(element, shape.center));
    shape.edge_u = 0.5 * element.attribute_number("width", 1.0, length) * axes[0];
    shape.edge_v = 0.5 * element.attribute_number("height", 1.0, length) * axes[1];
    return shape;
}

} // namespace vkvol
