#include "camera_rays.h"

#include <cmath>
#include <numbers>

#include "camera_view.h"

namespace vkvol {

namespace {

void set_angles(const Picture& picture, CameraRays& rays) {
    rays.angle_step = {2.0 * std::numbers::pi / picture.reference_width, -std::numbers::pi / picture.reference_height};
    rays.first_angle = glm::dvec2(-std::numbers::pi, std::numbers::pi / 2.0) +
                       glm::dvec2(picture.start_x, picture.start_y) * rays.angle_step;
}

} // namespace

glm::dvec3 CameraRays::origin(double x, double y) const {
    const bool from_plane = projection == Projection::orthographic || projection == Projection::irradiance;
    return from_plane ? position + corner + x * right + y * down : position;
}

glm::dvec3 CameraRays::direction(double x, double y) const {
    if (projection == Projection::orthographic || projection == Projection::irradiance)
        return forward;
    if (projection == Projection::perspective)
        return corner + x * right + y * down;
    const glm::dvec2 angle = first_angle + glm::dvec2(x, y) * angle_step;
    return std::cos(angle.y) * (std::cos(angle.x) * forward + std::sin(angle.x) * right) - std::sin(angle.y) * down;
}

double CameraRays::pixel_at(double distance) const {
    return projection == Projection::perspective       ? distance * glm::length(down)
           : projection != Projection::equirectangular ? glm::length(down)
                                                       : distance * -angle_step.y;
}

CameraRays camera_rays(const Camera& camera, const Picture& picture) {
    const bool is_rectangle = camera.projection == Projection::irradiance;
    const bool from_plane = is_rectangle || camera.projection == Projection::orthographic;
    // Half of the reference frame's height, on the plane at distance 1, or in the world.
    const double s = is_rectangle ? camera.size.y / 2.0
                     : from_plane ? camera.view_height / 2.0
                                  : std::tan(glm::radians(camera.fov) / 2.0);
    const double aspect =
        is_rectangle ? camera.size.x / camera.size.y : picture.reference_width / picture.reference_height;
    const double dx = 2.0 * aspect * s / picture.reference_width;
    const double dy = -2.0 * s / picture.reference_height;
    const glm::dmat3 rotation = camera_rotation(camera);
    CameraRays rays{};
    rays.projection = camera.projection;
    rays.position = camera.position;
    rays.forward = rotation * glm::dvec3(0.0, 0.0, -1.0);
    rays.corner =
        rotation * glm::dvec3(-aspect * s + picture.start_x * dx, s + picture.start_y * dy, from_plane ? 0.0 : -1.0);
    rays.right = rotation * glm::dvec3(dx, 0.0, 0.0);
    rays.down = rotation * glm::dvec3(0.0, dy, 0.0);
    if (camera.projection == Projection::equirectangular) {
        set_angles(picture, rays);
        rays.right = rotation * glm::dvec3(1.0, 0.0, 0.0);
        rays.down = rotation * glm::dvec3(0.0, -1.0, 0.0);
    }
    return rays;
}

SensorBox sensor_box(const Camera& camera, const Picture& picture) {
    if (camera.projection == Projection::absorption)
        return {camera.position - 0.5 * camera.edges, camera.position + 0.5 * camera.edges};
    const CameraRays rays = camera_rays(camera, picture);
    SensorBox box{rays.origin(0.0, 0.0), rays.origin(0.0, 0.0)};
    for (const glm::dvec2& corner : {glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(1.0, 1.0)}) {
        const glm::dvec3 place = rays.origin(corner.x * picture.width, corner.y * picture.height);
        box.low = glm::min(box.low, place);
        box.high = glm::max(box.high, place);
    }
    return box;
}

std::vector<glm::dvec3> reading_places(const Camera& camera, const Picture& picture, const Crop& window) {
    std::vector<glm::dvec3> places;
    if (!reads_flux(camera))
        return places;
    const CameraRays rays = camera_rays(camera, picture);
    const auto place = [&](int x, int y) {
        if (camera.projection == Projection::fluence)
            return camera.points[std::size_t(y) * std::size_t(picture.width) + std::size_t(x)];
        return camera.projection == Projection::absorption
                   ? camera.cell_low(camera.cell_of_pixel(x, y)) + 0.5 * camera.cell_size()
                   : rays.origin(x + 0.5, y + 0.5);
    };
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            places.push_back(place(x, y));
    return places;
}

} // namespace vkvol
