#include "camera.h"

#include <cmath>
#include <numbers>

namespace reference {

namespace {

// Right-handed rotation by `degrees` about a coordinate axis: turns axis + 1 towards axis + 2.
glm::dvec3 rotate(const glm::dvec3& v, int axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    glm::dvec3 r = v;
    r[a] = std::cos(angle) * v[a] - std::sin(angle) * v[b];
    r[b] = std::sin(angle) * v[a] + std::cos(angle) * v[b];
    return r;
}

} // namespace

Ray camera_ray(const vkvol::Camera& camera, const vkvol::Picture& picture, double x, double y) {
    const double s = std::tan(0.5 * camera.fov * std::numbers::pi / 180.0);
    const double aspect = picture.reference_width / picture.reference_height;
    const double u = (picture.start_x + x) / picture.reference_width;
    const double v = (picture.start_y + y) / picture.reference_height;
    glm::dvec3 d = glm::normalize(glm::dvec3((2.0 * u - 1.0) * aspect * s, (1.0 - 2.0 * v) * s, -1.0));
    d = rotate(d, 0, camera.pitch);
    d = rotate(d, 1, camera.yaw);
    d = rotate(d, 2, camera.roll);
    return {camera.position, d};
}

} // namespace reference
