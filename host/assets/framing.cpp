#include "framing.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

#include "camera_view.h"
#include "decimals.h"
#include "error.h"
#include "layers.h"
#include "loaded_medium.h"
#include "render_limits.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

Corners corners_between(glm::dvec3 low, glm::dvec3 high) {
    Corners corners;
    for (int i = 0; i < 8; ++i)
        corners[i] = glm::mix(low, high, glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    return corners;
}

Corners corners_of(const Mesh& mesh) {
    const glm::dvec3 low = lowest_corner(mesh);
    return corners_between(low, 2.0 * box_center(mesh) - low);
}

// One axis of the picture: where along it, and how far back, an eye sees all points between two slopes.
struct Side {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    double low_slope, high_slope;

    Side(double from, double to) : low_slope(from), high_slope(to) {}

    void include(double x, double z) {
        low = std::min(low, x + low_slope * z);
        high = std::max(high, x + high_slope * z);
    }
    double depth() const { return (high - low) / (high_slope - low_slope); } // the least
    double place(double depth) const { return 0.5 * (high - high_slope * depth + low - low_slope * depth); }
};

} // namespace

Corners corners_of(const DensityField& field) {
    Corners corners = corners_between(glm::dvec3(field.voxel_min) - 1.0, glm::dvec3(field.voxel_max) + 1.0);
    for (glm::dvec3& corner : corners)
        corner = glm::dvec3(field.index_to_world * glm::dvec4(corner, 1.0));
    return corners;
}

namespace {

Corners moved(const Volume& volume, Corners corners) {
    for (glm::dvec3& corner : corners)
        corner = glm::dvec3(volume.transform * glm::dvec4(corner, 1.0));
    return corners;
}

std::optional<Corners> corners_of(const Volume& volume, FieldCache& fields) {
    if ((volume.sigma_a + volume.sigma_s) * volume.density_scale == Rgb(0.0))
        return std::nullopt; // nothing is to be seen of it
    if (const auto* sphere = std::get_if<Sphere>(&volume.shape))
        return moved(volume, corners_between(sphere->center - sphere->radius, sphere->center + sphere->radius));
    if (volume.layers && !is_everywhere(volume)) {
        const LayerBox box = layer_box(volume);
        return moved(volume, corners_between(box.low, box.low + box.size));
    }
    if (const auto* box = std::get_if<Box>(&volume.shape))
        return moved(volume, corners_between(box->center - 0.5 * box->size, box->center + 0.5 * box->size));
    if (is_everywhere(volume))
        return std::nullopt; // there is no seeing all of it
    if (const auto* files = std::get_if<MeshFiles>(&volume.shape))
        return corners_of(load_mesh(*files, volume.transform));
    const GridFile& file = std::get<GridFile>(volume.shape);
    DensityField field = fields.take(file);
    field.place(volume.transform);
    return field.active_voxels > 0 ? std::optional(corners_of(field)) : std::nullopt;
}

// Corners of the box along the axes that holds both.
Corners corners_around(const Corners& a, const Corners& b) {
    glm::dvec3 low = a.front(), high = a.front();
    for (const Corners& corners : {a, b})
        for (const glm::dvec3& corner : corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    return corners_between(low, high);
}

} // namespace

std::optional<Corners> medium_corners(const Scene& scene, FieldCache& fields) {
    check_scene_limits(scene);
    fields.retain(grid_files(scene));
    std::optional<Corners> all;
    for (const Volume& volume : scene.volumes)
        if (const std::optional<Corners> corners = corners_of(volume, fields))
            all = all ? corners_around(*all, *corners) : *corners;
    return all;
}

glm::dvec3 middle_of(const Corners& corners) {
    return 0.5 * (corners.front() + corners.back());
}

double diagonal_of(const Corners& corners) {
    double longest = 0.0;
    for (int i = 0; i < 4; ++i)
        longest = std::max(longest, glm::length(corners[i] - corners[7 - i]));
    return longest;
}

namespace {

constexpr double filled = 0.94; // of the picture's width or height
constexpr double nearest = 0.1; // diagonals of the medium, from the eye to the nearest corner

// Frames an orthographic view: its height says how much is seen, and not the distance.
void frame_flat(Camera& camera, const Picture& picture, const Corners& corners) {
    const glm::dmat3 rotation = camera_rotation(camera);
    const ViewWindow window = view_window(camera, picture);
    const glm::dvec3 middle = middle_of(corners);
    glm::dvec3 high(-std::numeric_limits<double>::infinity());
    for (const glm::dvec3& corner : corners)
        high = glm::max(high, glm::abs(glm::transpose(rotation) * (corner - middle)));
    const double half =
        std::max(2.0 * high.x / (window.right - window.left), 2.0 * high.y / (window.top - window.bottom)) / filled;
    camera.view_height = 2.0 * half;
    const glm::dvec3 aside(-0.5 * half * (window.left + window.right), -0.5 * half * (window.bottom + window.top),
                           high.z + nearest * diagonal_of(corners));
    camera.position = middle + rotation * aside;
}

} // namespace

namespace {

// What was sharp before the medium may lie behind the eye that sees all of the medium.
void check_focus(const Lens& lens) {
    if (lens.radius <= widest_lens * lens.focus)
        return;
    const std::string where =
        lens.focus > 0.0 ? fmt::format("{:.3g} before it, too near for a lens of radius {:g}", lens.focus, lens.radius)
                         : fmt::format("{:.3g} behind it", -lens.focus);
    throw InputError(fmt::format("--frame: what is sharp stays where it is, and where the camera sees all of the "
                                 "medium that is {}; raise <camera> focus, or give lookAt, a point of the medium, in "
                                 "its place",
                                 where));
}

} // namespace

void keep_focus(Camera& camera, const glm::dvec3& moved) {
    if (camera.lens.radius == 0.0)
        return;
    camera.lens.focus += glm::dot(moved, camera_rotation(camera)[2]);
    check_focus(camera.lens);
}

void frame(Camera& camera, const Picture& picture, const Corners& corners) {
    if (camera.projection == Projection::orthographic)
        return frame_flat(camera, picture, corners);
    const glm::dmat3 rotation = camera_rotation(camera);
    const ViewWindow window = view_window(camera, picture);
    const auto narrowed = [](double from, double to) {
        const double middle = 0.5 * (from + to), half = 0.5 * filled * (to - from);
        return Side(middle - half, middle + half);
    };
    Side across = narrowed(window.left, window.right), upwards = narrowed(window.bottom, window.top);
    // About the middle, so that a box far from the origin loses no digits.
    const glm::dvec3 middle = middle_of(corners);
    double towards_eye = -std::numeric_limits<double>::infinity();
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 seen = glm::transpose(rotation) * (corner - middle);
        across.include(seen.x, seen.z);
        upwards.include(seen.y, seen.z);
        towards_eye = std::max(towards_eye, seen.z);
    }
    // A wide view could have the nearest corner in the eye itself.
    const double depth = std::max({across.depth(), upwards.depth(), towards_eye + nearest * diagonal_of(corners)});
    const glm::dvec3 before = camera.position;
    camera.position = middle + rotation * glm::dvec3(across.place(depth), upwards.place(depth), depth);
    keep_focus(camera, camera.position - before);
}

// Around what stands in for media where there are none.
std::optional<Corners> surface_corners(const Scene& scene) {
    const std::optional<SurfaceBounds> bounds = bounds_of(with_surface_files(scene).surfaces);
    return bounds ? std::optional(corners_between(bounds->low, bounds->high)) : std::nullopt;
}

void frame_medium(Scene& scene, FieldCache& fields) {
    if (reads_flux(scene.camera))
        throw InputError(fmt::format("--frame: <{}> reads flux where the scene has it, and is no camera to be moved; "
                                     "leave --frame out",
                                     projection_name(scene.camera.projection)));
    const std::optional<Corners> corners =
        scene.volumes.empty() ? surface_corners(scene) : medium_corners(scene, fields);
    if (!corners)
        throw InputError(
            scene.volumes.empty() ? "--frame: the scene has no medium to frame, and no surface but planes; leave "
                                    "--frame out"
            : std::any_of(scene.volumes.begin(), scene.volumes.end(), is_everywhere)
                ? "--frame: <everywhere> has no box to frame; leave --frame out"
                : "--frame: the medium holds nothing, or is a grid without voxels, and there is nothing to "
                  "frame; leave --frame out, or give it an extinction, or another grid with --grid FILE");
    if (scene.camera.projection == Projection::equirectangular)
        throw InputError("--frame: an equirectangular camera sees all around it, wherever it is; leave --frame out");
    frame(scene.camera, scene.picture, *corners);
}

std::string give_camera(Scene& scene, FieldCache& fields) {
    if (scene.has_camera)
        return "";
    const std::optional<Corners> of_media = medium_corners(scene, fields);
    const bool has_media = of_media.has_value();
    const std::optional<Corners> corners = has_media ? of_media : surface_corners(scene);
    if (!corners)
        return scene.surfaces.empty() ? ""
                                      : "the scene has no <camera>, and nothing that could be framed: it is at the "
                                        "origin and looks along -z";
    scene.camera.fov = usual_fov;
    Orbit orbit;
    orbit.azimuth = usual_azimuth;
    orbit.elevation = usual_elevation;
    place_on_orbit(scene.camera, orbit);
    frame(scene.camera, scene.picture, *corners);
    const glm::dvec3 forward = -camera_rotation(scene.camera)[2];
    const double distance = glm::dot(middle_of(*corners) - scene.camera.position, forward);
    const glm::dvec3 target = scene.camera.position + distance * forward;
    const auto text = [decimals = decimals_for(diagonal_of(*corners))](double v) { return short_text(v, decimals); };
    return fmt::format("the scene has no <camera>: this one frames its {}, <camera lookAt=\"{} {} {}\" distance=\"{}\" "
                       "azimuth=\"{:g}\" elevation=\"{:g}\" fov=\"{:g}\"/>",
                       has_media ? "media" : "surfaces", text(target.x), text(target.y), text(target.z), text(distance),
                       orbit.azimuth, orbit.elevation, scene.camera.fov);
}

} // namespace vkvol
