#include "sensor_params.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera_rays.h"
#include "camera_view.h"
#include "shared/constants.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

// Whether the plane is between the eye and where rays would begin, for some of the picture's rays.
bool cuts_off(const PlaneSurface& plane, const Scene& scene, const CameraRays& rays, double start) {
    const Lens& camera_lens = scene.camera.lens;
    const double lens =
        camera_lens.radius > 0.0 ? camera_lens.radius * std::max(1.0, std::abs(start / camera_lens.focus - 1.0)) : 0.0;
    bool before = false, behind = false;
    for (const double x : {0.0, double(scene.picture.width)})
        for (const double y : {0.0, double(scene.picture.height)}) {
            const bool has_eye = rays.projection == Projection::perspective;
            const glm::dvec3 slope = rays.corner + x * rays.right + y * rays.down;
            const glm::dvec3 eye = has_eye ? rays.position : rays.origin(x, y);
            const glm::dvec3 end = eye + start * (has_eye ? slope : rays.forward);
            for (const glm::dvec3& point : {eye, end}) {
                const double height = glm::dot(plane.normal, point - plane.point);
                before = before || height > -lens;
                behind = behind || height < lens;
            }
        }
    return before && behind;
}

// How far before the eye rays begin. In single precision a point at distance D is known to D * 6e-8, and so is where a
// ray of unit direction from the eye comes to be there. From afar rays therefore begin on a plane before all there is,
// one radius away from it; from nearer than 16 radii, where the eye itself is as good, at the eye.
double ray_start(const Scene& scene, const CameraRays& rays, glm::dvec3 center, double radius) {
    const double depth = glm::dot(rays.forward, center - scene.camera.position) - 2.0 * radius;
    if (scene.periodic || !(depth > 16.0 * radius))
        return 0.0;
    const bool is_cut_off = std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& surface) {
        const auto* plane = std::get_if<PlaneSurface>(&surface.shape);
        return plane && cuts_off(*plane, scene, rays, depth);
    });
    return is_cut_off ? 0.0 : depth;
}

shared::SensorParams make_pinhole(const Scene& scene, const CameraRays& rays, glm::dvec3 origin, double radius) {
    const double start = ray_start(scene, rays, origin, radius);
    shared::SensorParams params{};
    params.position = rays.position - origin + start * rays.corner;
    params.start = static_cast<float>(start);
    params.corner = rays.corner;
    params.right = rays.right;
    params.down = rays.down;
    params.forward = rays.forward;
    const Lens& lens = scene.camera.lens;
    if (lens.radius > 0.0) {
        const glm::dmat3 rotation = camera_rotation(scene.camera);
        params.lens_u = lens.radius / lens.focus * rotation[0];
        params.lens_v = lens.radius / lens.focus * rotation[1];
        params.lens_lever = static_cast<float>(lens.focus - start);
        params.blades = static_cast<std::uint32_t>(lens.blades);
        const double turn = 360.0 / std::max(lens.blades, 1); // after which the aperture is the same
        params.blade_rotation = static_cast<float>(glm::radians(std::remainder(lens.rotation, turn)));
    }
    return params;
}

} // namespace

shared::SensorParams sensor_params(const Scene& scene, const glm::dvec3& origin, double radius) {
    const CameraRays rays = camera_rays(scene.camera, scene.picture);
    const std::optional<SurfaceBounds> bounds = bounds_of(scene.surfaces);
    if (bounds)
        radius = std::max(radius, reach_of(*bounds, origin));
    if (rays.projection == Projection::perspective)
        return make_pinhole(scene, rays, origin, radius);
    shared::SensorParams params{};
    if (rays.projection == Projection::absorption) {
        params.position = scene.camera.cell_low({0, 0, 0}) - origin;
        params.corner = scene.camera.cell_size();
        params.right = {params.corner.x, 0.0f, 0.0f};
        params.down = {0.0f, -params.corner.y, 0.0f};
        params.cells = scene.camera.cells;
        return params;
    }
    params.position = rays.origin(0.0, 0.0) - origin;
    if (rays.projection == Projection::orthographic) {
        const double start = ray_start(scene, rays, origin, radius);
        params.position += start * rays.forward;
        params.start = static_cast<float>(start);
    }
    params.forward = rays.forward;
    params.corner = rays.forward;
    params.right = rays.right;
    params.down = rays.down;
    // What turns around once more is left out: single precision would have nothing left for the angle.
    params.first_angle = {std::remainder(rays.first_angle.x, 2.0 * std::numbers::pi),
                          std::remainder(rays.first_angle.y, 2.0 * std::numbers::pi)};
    params.angle_step = rays.angle_step;
    params.row = static_cast<std::uint32_t>(scene.picture.width);
    return params;
}

} // namespace vkvol
