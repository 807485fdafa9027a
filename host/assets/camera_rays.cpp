#include "camera_rays.h"

#include <cmath>

#include "camera_view.h"

namespace vkvol {

CameraRays camera_rays(const Camera& camera, const Picture& picture) {
    const double s = std::tan(glm::radians(camera.fov) / 2.0);
    const double aspect = picture.reference_width / picture.reference_height;
    const double dx = 2.0 * aspect * s / picture.reference_width;
    const double dy = -2.0 * s / picture.reference_height;
    const glm::dmat3 rotation = camera_rotation(camera);
    CameraRays rays{};
    rays.position = camera.position;
    rays.forward = rotation * glm::dvec3(0.0, 0.0, -1.0);
    rays.corner = rotation * glm::dvec3(-aspect * s + picture.start_x * dx, s + picture.start_y * dy, -1.0);
    rays.right = rotation * glm::dvec3(dx, 0.0, 0.0);
    rays.down = rotation * glm::dvec3(0.0, dy, 0.0);
    return rays;
}

} // namespace vkvol
