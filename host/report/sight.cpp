#include "sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkvol {

namespace {

constexpr int usual_rows = 24; // of the lattice, and columns
constexpr int fine_rows = 300;

// Calls visit(origin, direction) for points spread evenly over [x0, x1) x [y0, y1), pixel centres where these are few.
template <class Visit>
void for_lattice(const CameraRays& rays, double x0, double x1, double y0, double y1, int most_rows,
                 const Visit& visit) {
    const int columns = std::clamp(int(x1 - x0), 1, most_rows), rows = std::clamp(int(y1 - y0), 1, most_rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double x = x0 + (x1 - x0) * (column + 0.5) / columns, y = y0 + (y1 - y0) * (row + 0.5) / rows;
            visit(rays.origin(x, y), rays.direction(x, y));
        }
}

double part_entering(const MediumOutline& outline, const CameraRays& rays, double x0, double x1, double y0, double y1,
                     int most_rows = usual_rows) {
    int entering = 0, all = 0;
    for_lattice(rays, x0, x1, y0, y1, most_rows, [&](glm::dvec3 origin, glm::dvec3 direction) {
        entering += crossing(outline, origin, direction).has_value();
        ++all;
    });
    return double(entering) / all;
}

double degrees_between(glm::dvec3 a, glm::dvec3 b) {
    const double length = glm::length(a) * glm::length(b);
    return length > 0.0 ? glm::degrees(std::acos(std::clamp(glm::dot(a, b) / length, -1.0, 1.0))) : 0.0;
}

// Whether a window, in pixels, has the box before it or a part of it: by the rectangle around its corners, and where
// some of these are behind the eye, not. A panorama has all around it before it.
bool overlaps(const WorldBox& box, const CameraRays& rays, const Crop& window) {
    if (rays.projection == Projection::equirectangular)
        return true;
    const bool is_flat = rays.projection == Projection::orthographic;
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    const glm::dmat3 to_picture = glm::inverse(glm::dmat3(rays.right, rays.down, is_flat ? rays.forward : rays.corner));
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 p = to_picture * (glm::mix(box.low, box.high, pick) - rays.origin(0.0, 0.0));
        if (!(p.z > 0.0))
            return false;
        const glm::dvec2 seen = glm::dvec2(p) / (is_flat ? 1.0 : p.z);
        low = glm::min(low, seen);
        high = glm::max(high, seen);
    }
    return low.x < window.x1 && high.x > window.x0 && low.y < window.y1 && high.y > window.y0;
}

} // namespace

Sight sight_of(const Scene& scene, const MediumOutline& outline, const Crop& crop) {
    const CameraRays rays = camera_rays(scene.camera, scene.picture);
    const Picture& picture = scene.picture;
    Sight sight;
    sight.eye = rays.position;
    sight.forward = rays.forward;
    sight.box = world_box(outline);
    sight.inside = is_within(outline, rays.position);
    const glm::dvec3 apart = 0.5 * (sight.box.low + sight.box.high) - rays.position;
    const glm::dvec3 middle =
        rays.direction(0.5 * picture.width, 0.5 * picture.height); // of the picture, not of its frame
    sight.degrees_off = degrees_between(middle, apart);
    if (!sight.inside && glm::length(apart) > 0.0)
        sight.pixels = glm::length(sight.box.high - sight.box.low) / rays.pixel_at(glm::length(apart));
    sight.least_depth = std::numeric_limits<double>::infinity();
    for_lattice(rays, crop.x0, crop.x1, crop.y0, crop.y1, usual_rows, [&](glm::dvec3 origin, glm::dvec3 direction) {
        const double depth = depth_bound(outline, origin, direction);
        sight.most_depth = std::max(sight.most_depth, depth);
        sight.least_depth = std::min(sight.least_depth, depth);
    });
    sight.entering = part_entering(outline, rays, crop.x0, crop.x1, crop.y0, crop.y1);
    sight.entering_picture = part_entering(outline, rays, 0, picture.width, 0, picture.height);
    sight.entering_frame = part_entering(outline, rays, -picture.start_x, picture.reference_width - picture.start_x,
                                         -picture.start_y, picture.reference_height - picture.start_y);
    // What lies between the lattice's rays.
    if (sight.entering == 0.0 && overlaps(sight.box, rays, crop)) {
        sight.entering = part_entering(outline, rays, crop.x0, crop.x1, crop.y0, crop.y1, fine_rows);
        sight.in_window = sight.entering > 0.0 || sight.pixels * 100.0 < std::min(crop.x1 - crop.x0, crop.y1 - crop.y0);
    }
    sight.in_window = sight.in_window || sight.entering > 0.0;
    return sight;
}

} // namespace vkvol
