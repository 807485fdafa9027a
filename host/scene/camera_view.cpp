#include "camera_view.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace vkvol {

namespace {

// The unit vector along any vector but 0, whose square might overflow or vanish.
glm::dvec3 unit(glm::dvec3 v) {
    return glm::normalize(v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

// The angles of a rotation, in turn: each is taken from what the ones before it leave, so that looking along the x
// axis, where roll and pitch turn about the same one, costs no accuracy.
void set_angles(Camera& camera, const glm::dmat3& rotation) {
    const glm::dvec3 right = rotation[0], up = rotation[1];
    const double flat = std::hypot(right.x, right.y);
    const double roll = flat > 1e-12 ? std::atan2(right.y, right.x) : 0.0;
    const double c = std::cos(roll), s = std::sin(roll);
    camera.roll = glm::degrees(roll);
    camera.yaw = glm::degrees(std::atan2(-right.z, c * right.x + s * right.y));
    const glm::dvec3 back = rotation[2];
    camera.pitch = glm::degrees(std::atan2(s * back.x - c * back.y, c * up.y - s * up.x));
}

// The shortest turn that takes y to `up`.
glm::dmat3 turn_to(glm::dvec3 up) {
    const glm::dvec3 y(0.0, 1.0, 0.0), axis = glm::cross(y, up);
    const double sine = glm::length(axis);
    if (sine < 1e-12)
        return up.y > 0.0 ? glm::dmat3(1.0) : glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), std::atan2(sine, up.y), axis));
}

} // namespace

glm::dmat3 camera_rotation(const Camera& camera) {
    glm::dmat4 m(1.0);
    m = glm::rotate(m, glm::radians(camera.roll), glm::dvec3(0, 0, 1));
    m = glm::rotate(m, glm::radians(camera.yaw), glm::dvec3(0, 1, 0));
    m = glm::rotate(m, glm::radians(camera.pitch), glm::dvec3(1, 0, 0));
    return glm::dmat3(m);
}

bool is_parallel(glm::dvec3 forward, glm::dvec3 up) {
    return glm::length(glm::cross(unit(forward), unit(up))) < 1e-6;
}

void look_along(Camera& camera, glm::dvec3 forward, glm::dvec3 up) {
    forward = unit(forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, unit(up)));
    set_angles(camera, {right, glm::cross(right, forward), -forward});
}

void place_on_orbit(Camera& camera, const Orbit& orbit) {
    camera.yaw = orbit.azimuth;
    camera.pitch = -orbit.elevation;
    camera.roll = 0.0;
    if (const glm::dvec3 up = unit(orbit.up); up != glm::dvec3(0.0, 1.0, 0.0))
        set_angles(camera, turn_to(up) * camera_rotation(camera));
    camera.position = orbit.target + orbit.distance * camera_rotation(camera)[2];
}

const char* projection_name(Projection projection) {
    switch (projection) {
    case Projection::orthographic:
        return "orthographic";
    case Projection::equirectangular:
        return "equirectangular";
    case Projection::irradiance:
        return "irradiance";
    case Projection::fluence:
        return "fluence";
    case Projection::absorption:
        return "absorption";
    default:
        return "perspective";
    }
}

double stops_of(const Exposure& exposure) {
    const double white = 1.2 * exposure.f_number * exposure.f_number / exposure.shutter * 100.0 / exposure.iso;
    return std::log2(exposure.luminance_unit / white);
}

ViewWindow view_window(const Camera& camera, const Picture& picture) {
    const double s = camera.projection == Projection::orthographic ? 1.0 : std::tan(glm::radians(camera.fov) / 2.0);
    const double aspect = picture.reference_width / picture.reference_height;
    const auto x = [&](double pixel) { return aspect * s * (2.0 * pixel / picture.reference_width - 1.0); };
    const auto y = [&](double pixel) { return s * (1.0 - 2.0 * pixel / picture.reference_height); };
    return {x(picture.start_x), x(picture.start_x + picture.width), y(picture.start_y + picture.height),
            y(picture.start_y)};
}

} // namespace vkvol
