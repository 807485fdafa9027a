#include "render_limits.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "camera_rays.h"
#include "error.h"
#include "layers.h"
#include "method.h"
#include "noise.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "shared/estimators.h"

namespace vkvol {

namespace {

// Per ray: at a million a second it takes ten seconds, and a pixel takes many.
constexpr double most_collisions = 1e7;
// As of other marches.
constexpr double most_steps = 1e6;
// Limit to the sigmas in world units, times the largest density.
constexpr double largest_extinction = 1e30;

// The medium's box as a camera meets it, world space.
struct Extent {
    glm::dvec3 center{0.0};
    double diagonal = 0.0;
};

// Extent of a shape after its volume's transform; `center` and `diagonal` are those before it. The diagonal grows by as
// much as the axis that grows most.
Extent moved(const Volume& volume, glm::dvec3 center, double diagonal) {
    double stretch = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        stretch = std::max(stretch, glm::length(glm::dvec3(volume.transform[axis])));
    return {glm::dvec3(volume.transform * glm::dvec4(center, 1.0)), stretch * diagonal};
}

Extent extent_of(const Volume& volume, const LoadedMedium& loaded) {
    if (loaded.is_layered) {
        const LayerBox box = layer_box(volume);
        return moved(volume, box.low + 0.5 * box.size, glm::length(box.size));
    }
    if (const auto* sphere = std::get_if<Sphere>(&volume.shape))
        return moved(volume, sphere->center, 2.0 * sphere->radius);
    if (const auto* box = std::get_if<Box>(&volume.shape))
        return moved(volume, box->center, glm::length(box->size));
    if (loaded.mesh)
        return {box_center(*loaded.mesh), 2.0 * glm::length(box_center(*loaded.mesh) - lowest_corner(*loaded.mesh))};
    const glm::dvec3 low(loaded.field->voxel_min), high(loaded.field->voxel_max);
    const glm::dmat4& to_world = loaded.field->index_to_world;
    return {glm::dvec3(to_world * glm::dvec4(0.5 * (low + high), 1.0)),
            glm::length(glm::dmat3(to_world) * (high - low + 2.0))};
}

// The majorant's optical depth along a ray through the whole medium at its mean, and through the densest cell. A sum
// over all cells at the largest bound would refuse media for a single spike.
double majorant_depth(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, double diagonal,
                      double sigma_t) {
    if (!loaded.majorants) {
        const double bound = volume.noise ? noise_bound(*volume.noise) : 1.0;
        return sigma_t * bound * scene.settings.majorant_scale * diagonal;
    }
    const double cell = loaded.field ? std::sqrt(3.0) * loaded.majorants->cell * loaded.field->voxel_size() : diagonal;
    return sigma_t * (loaded.majorants->mean * diagonal + loaded.majorants->most * std::min(cell, diagonal));
}

void check_patience(const Scene& scene, const Method& method, double depth) {
    const bool null_collisions = method.flights_have(TRAIT_NULL) || method.shadow_rays_have(TRAIT_NULL);
    if (null_collisions && !(depth <= most_collisions))
        throw InputError(
            fmt::format("a ray through the medium meets {:.3g} tentative collisions, and would never get "
                        "through; lower sigma_a, sigma_s, lightRayDensityMultiplier or the majorant's scale "
                        "until it meets {:g}, or check the unit of sigma_a and sigma_s",
                        depth, most_collisions));
    const double optical_step = scene.settings.march.optical_step;
    if (method.flights_have(TRAIT_OPTICAL_STEPS) && !(depth / optical_step <= most_steps))
        throw InputError(fmt::format("<march> opticalStep: {:g} takes {:.3g} steps across the medium, more than a "
                                     "million; {:.3g} takes a thousand",
                                     optical_step, depth / optical_step, depth / 1000.0));
}

void check_extinction(const Volume& volume, const LoadedMedium& loaded) {
    const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    double densest = 1.0;
    if (loaded.majorants)
        densest = std::max(densest, loaded.majorants->most);
    const bool vanishes = sigma_t > 0.0 && sigma_t < 1.0 / largest_extinction;
    if (vanishes || !(sigma_t * densest <= largest_extinction))
        throw InputError(
            fmt::format("the extinction is {:.3g} per world unit at density 1 and {:.3g} where the medium is "
                        "densest, beyond single precision; change sigma_a and sigma_s, or the grid's voxel "
                        "size",
                        sigma_t, sigma_t * densest));
}

// Nothing so small is seen, and squares of distances in units of the medium must be finite.
void check_distance(const Scene& scene, const Extent& extent) {
    constexpr double farthest = 1e12; // diagonals
    const auto check = [&](const char* what, glm::dvec3 place) {
        const double distance = glm::length(place - extent.center);
        if (!(extent.diagonal * farthest >= distance))
            throw InputError(fmt::format("the medium measures {:.3g} and the {} is {:.3g} away, more than {:g} times "
                                         "that; move the {} or enlarge the medium",
                                         extent.diagonal, what, distance, farthest, what));
    };
    check(reads_flux(scene.camera) ? "sensor" : "camera", scene.camera.position);
    for (const glm::dvec3& point : scene.camera.points)
        check("point", point);
}

void check_glow(const Volume& volume, const LoadedMedium& loaded) {
    const double most = hottest_radiance(volume, loaded);
    const bool by_kelvin = volume.temperature.model == TemperatureEmission::Model::blackbody;
    if (!(most <= brightest_light))
        throw InputError(
            fmt::format("<emission> reaches a radiance of {:.3g} where \"{}\" is {}, but {:g} is the most; "
                        "lower its multiplier{}",
                        most, volume.temperature.grid, by_kelvin ? "hottest" : "largest", brightest_light,
                        by_kelvin ? " or temperatureScale, or raise referenceTemperature" : ""));
}

void check_periodic(const Scene& scene) {
    const auto fail = [](const char* message) { throw InputError(std::string("<periodic>: ") + message); };
    if (std::any_of(scene.lights.begin(), scene.lights.end(), has_place))
        fail("a light that has a place would stand in every domain that there is; take directional lights, suns and "
             "skies, or surfaces that shine");
    for (const Surface& surface : scene.surfaces)
        if (const auto* plane = std::get_if<PlaneSurface>(&surface.shape))
            for (int axis = 0; axis < 3; ++axis)
                if (scene.periodic->size()[axis] > 0.0 &&
                    std::abs(plane->normal[axis]) > 1e-9) // what turning it leaves
                    fail("a plane has to lie along all axes that repeat; turn it, or take a rectangle");
}

// How far a point is from what is neither a mesh, a box nor a plane, over the size of what rays from there go by.
struct DistanceTo {
    glm::dvec3 point;

    double operator()(const BallSurface& ball) const {
        return std::abs(glm::length(point - ball.center) - ball.radius) / ball.radius;
    }
    double operator()(const DiskSurface& disk) const {
        const double up = glm::dot(disk.normal, point - disk.center);
        const double out = glm::length(point - disk.center - up * disk.normal) - disk.radius;
        return std::hypot(up, std::max(out, 0.0)) / disk.radius;
    }
    double operator()(const RectangleSurface& r) const {
        const glm::dvec3 aside = point - r.center;
        const double u = glm::length(r.edge_u), v = glm::length(r.edge_v);
        const glm::dvec3 at(glm::dot(aside, r.edge_u) / u, glm::dot(aside, r.edge_v) / v,
                            glm::dot(aside, glm::normalize(glm::cross(r.edge_u, r.edge_v))));
        return glm::length(glm::dvec3(std::max(std::abs(at.x) - u, 0.0), std::max(std::abs(at.y) - v, 0.0), at.z)) /
               std::max(u, v);
    }
    template <class Shape> double operator()(const Shape&) const { return std::numeric_limits<double>::infinity(); }
};

[[noreturn]] void fail_at(const Surface& surface, const std::string& why) {
    throw InputError(surface.place.empty() ? why : surface.place + ": " + why);
}

[[noreturn]] void fail_in(const Surface& surface, const glm::dvec3& point) {
    fail_at(surface, fmt::format("<fluence>: the point {:g} {:g} {:g} lies in this surface, and would read what is on "
                                 "both sides; lift it off, to the side that is meant",
                                 point.x, point.y, point.z));
}

// Where light without extent comes from.
std::optional<glm::dvec3> source_of(const Light& light) {
    if (const auto* point = std::get_if<PointLight>(&light))
        return point->position;
    if (const auto* spot = std::get_if<SpotLight>(&light))
        return spot->position;
    return std::nullopt;
}

// Rays from a point in a surface would read what is on both sides of it.
void check_points(const Scene& scene) {
    for (const glm::dvec3& point : scene.camera.points)
        for (const Surface& surface : scene.surfaces)
            if (std::visit(DistanceTo{point}, surface.shape) <= SURFACE_SPARE)
                fail_in(surface, point);
    for (const glm::dvec3& point : scene.camera.points)
        for (const Light& light : scene.lights)
            if (const std::optional<glm::dvec3> source = source_of(light);
                source && glm::distance(*source, point) <= 1e-12 * glm::length(point))
                throw InputError(
                    fmt::format("<fluence>: at the point {:g} {:g} {:g} is a <point> or <spot> light, whose "
                                "fluence there is infinite; move the one or the other",
                                point.x, point.y, point.z));
}

} // namespace

void check_scene_limits(const Scene& scene) {
    if (scene.periodic)
        check_periodic(scene);
    check_points(scene);
    const auto is_map = [](const Light& light) { return std::holds_alternative<SkyLight>(light); };
    if (std::count_if(scene.lights.begin(), scene.lights.end(), is_map) > 1)
        throw InputError("a scene with several maps of the sky is not rendered by this version; keep one");
    const auto is_plane = [](const Surface& surface) { return std::holds_alternative<PlaneSurface>(surface.shape); };
    if (const auto planes = std::count_if(scene.surfaces.begin(), scene.surfaces.end(), is_plane); planes > MOST_PLANES)
        throw InputError(fmt::format("{} planes are more than the {} that are rendered; make rectangles of some",
                                     planes, MOST_PLANES));
    // Every camera ray asks all lamps, and every path that leaves all suns.
    constexpr std::ptrdiff_t most_lamps = 4096, most_suns = 256;
    if (const auto lamps = std::count_if(scene.lights.begin(), scene.lights.end(), is_lamp); lamps > most_lamps)
        throw InputError(fmt::format("{} spheres, disks and rectangles of light are more than the {} that can be seen; "
                                     "make most of them points",
                                     lamps, most_lamps));
    if (const auto suns = std::count_if(scene.lights.begin(), scene.lights.end(), is_met_by_chance); suns > most_suns)
        throw InputError(fmt::format("{} suns are more than the {} that are rendered; make most of them directional",
                                     suns, most_suns));
}

// A ball of optical depth 1e6 across, of albedo 0.9 in an even sky, shines by 3 % too little, one of 1e7 by 6 %, and
// all beyond by 20 %: a path that collides nearer to the face than places are known to leaves by chance.
std::string too_short_paths(const Scene& scene, const Volume& volume, const LoadedMedium& loaded) {
    constexpr double most = 3e5; // mean free paths in half of the medium's diagonal
    const bool empty_grid = std::holds_alternative<GridFile>(volume.shape) && !loaded.field;
    if (empty_grid || is_everywhere(volume) || volume.sigma_s * most_map_albedo(volume) == Rgb(0.0))
        return "";
    const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    const double densest = loaded.majorants ? loaded.majorants->most / scene.settings.majorant_scale
                           : volume.noise   ? noise_bound(*volume.noise)
                                            : 1.0;
    const double size = 0.5 * extent_of(volume, loaded).diagonal, paths = sigma_t * densest * size;
    if (!(paths > most))
        return "";
    return fmt::format(
        "where the medium is densest a mean free path is {:.1e} world units, of the size that single "
        "precision tells places apart by in a medium of this size, and light that scatters near its faces "
        "is wrong by some per cent; {:.0e} of the density looks the same, and is right",
        1.0 / (sigma_t * densest), most / paths);
}

void check_sensor_in_planes(const Scene& scene, const glm::dvec3& origin) {
    for (const Surface& surface : scene.surfaces) {
        const auto* plane = std::get_if<PlaneSurface>(&surface.shape);
        if (!plane)
            continue;
        const double middle = glm::dot(plane->normal, origin - plane->point);
        // As nearly as kernels know both, or as decimals do in which they were written.
        const auto lies_in_it = [&](const glm::dvec3& point, double extent) {
            const double reach = std::max(glm::length(point - origin) + extent, std::abs(middle));
            const double written = 1e-8 * (glm::length(point) + glm::length(plane->point));
            return std::abs(glm::dot(plane->normal, point - plane->point)) <= std::max(SURFACE_SPARE * reach, written);
        };
        for (const glm::dvec3& point : scene.camera.points)
            if (lies_in_it(point, 0.0))
                fail_in(surface, point);
        // Such a sensor is kept off the plane to where it faces: behind a ground, where it would read what is not
        // there.
        if (scene.camera.projection != Projection::irradiance)
            continue;
        const CameraRays rays = camera_rays(scene.camera, scene.picture);
        const double extent =
            0.5 * (glm::length(rays.right) * scene.picture.width + glm::length(rays.down) * scene.picture.height);
        if (glm::dot(plane->normal, rays.forward) < -0.5 && lies_in_it(scene.camera.position, extent))
            fail_at(surface, "<irradiance>: it lies in this plane and faces into it; lift it off, to the side that is "
                             "meant");
    }
}

void check_limits(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, const Method& method) {
    const bool empty_grid = std::holds_alternative<GridFile>(volume.shape) && !loaded.field;
    if (empty_grid)
        return;
    check_extinction(volume, loaded);
    if (is_everywhere(volume)) // see check_everywhere
        return;
    const Extent extent = extent_of(volume, loaded);
    check_distance(scene, extent);
    const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    check_patience(scene, method, majorant_depth(scene, volume, loaded, extent.diagonal, sigma_t));
    check_glow(volume, loaded);
}

void check_limits(const Scene& scene, const Superposition& whole, const Method& method) {
    const double coarse = whole.edge * std::exp2(whole.bits);
    double most = 0.0; // collisions across a cell
    for (std::size_t i = 0; i < whole.cells.bounds.size(); ++i)
        if (whole.bricks.empty() || whole.bricks[i] == 0) // else finer ones are walked through
            most = std::max(most, coarse * whole.cells.bounds[i]);
    for (const float bound : whole.brick_bounds)
        most = std::max(most, whole.edge * bound);
    check_patience(scene, method, whole.mean_bound() * whole.diagonal() + std::sqrt(3.0) * most);
}

// What multiplies the albedo where it is least, as far as the scene tells: a grid's values may be 0.
Rgb least_map_albedo(const Volume& volume) {
    Rgb least(volume.albedo_grid.empty() ? 1.0 : 0.0);
    for (const MapPoint& point : volume.map.points)
        least = volume.map.is_transfer ? glm::min(least, point.albedo) : least;
    return least;
}

// What is lost of light per world unit where the density is 1 and what multiplies the albedo is that; as world_sigma_t.
Rgb lost_in(const Volume& volume, const Rgb& albedo, const DensityField* field) {
    Volume losses = volume;
    losses.sigma_a += (Rgb(1.0) - albedo) * volume.sigma_s;
    losses.sigma_s = Rgb(0.0);
    return world_sigma_t(losses, field);
}

// In a channel that collides, compared to that.
bool is_lossless(const Rgb& lost, const Rgb& sigma_t) {
    for (int channel = 0; channel < 3; ++channel)
        if (sigma_t[channel] > 0.0 && lost[channel] < 1e-6 * sigma_t[channel])
            return true;
    return false;
}

// A path that never comes to an end would be followed for ever. Of several media what they lose together counts.
void check_everywhere(const Scene& scene, const std::vector<LoadedMedium>& media, int scattering) {
    constexpr double thinnest = 1e-15; // whose mean free path is a hundred thousandth of the way to where it ends
    std::string place, endless_place;  // of the first
    Rgb all(0.0), endless(0.0), lost(0.0);
    for (std::size_t i = 0; i < media.size(); ++i) {
        const Volume& volume = scene.volumes[i];
        if (!is_everywhere(volume))
            continue;
        const std::string here = volume.place.empty() ? "" : volume.place + ": ";
        place = place.empty() ? here : place;
        const Rgb sigma_t = world_sigma_t(volume, nullptr);
        all += sigma_t;
        if (media[i].is_layered)
            continue;
        endless_place = endless_place.empty() ? here : endless_place;
        endless += sigma_t;
        lost += lost_in(volume, most_map_albedo(volume), nullptr);
    }
    if (largest(all) > 0.0 && largest(all) < thinnest)
        throw InputError(
            fmt::format("{}the extinction, {:.3g} per world unit, is too thin to be <everywhere>; expected "
                        "at least {:g}, or a <box>",
                        place, largest(all), thinnest));
    if (is_lossless(lost, endless) && !scene.settings.max_depth && scattering == SCATTERING_MULTIPLE)
        throw InputError(endless_place +
                         "a medium that is <everywhere> and absorbs nothing keeps its paths for ever; raise "
                         "sigma_a, or give a <maxDepth>");
}

std::string lights_shut_out(const Scene& scene) {
    const auto is_endless = [](const Volume& volume) {
        return is_everywhere(volume) && !volume.layers &&
               glm::all(glm::greaterThan(world_sigma_t(volume, nullptr), Rgb(0.0)));
    };
    const auto is_far = [](const Light& light) {
        return std::holds_alternative<DirectionalLight>(light) || std::holds_alternative<SunLight>(light) ||
               std::holds_alternative<SkyLight>(light);
    };
    const auto medium = std::find_if(scene.volumes.begin(), scene.volumes.end(), is_endless);
    if (medium == scene.volumes.end() || std::none_of(scene.lights.begin(), scene.lights.end(), is_far))
        return "";
    return fmt::format(
        "{}{}a medium that is <everywhere> has no end, and so lets no light through from <light>, <sun> or "
        "<sky>; a <box> or <sphere> about camera and scene would end it, and <layers> let it thin out",
        medium->place, medium->place.empty() ? "" : ": ");
}

void check_way_out(const Scene& scene, const std::vector<LoadedMedium>& media, int scattering) {
    const bool has_way_out = !scene.periodic || glm::any(glm::equal(scene.periodic->size(), glm::dvec3(0.0)));
    const auto absorbs = [](const Surface& surface) {
        const Rgb& color = surface.material.color;
        return surface.material.kind == MaterialKind::conductor || is_textured(surface.material) ||
               std::max({color.x, color.y, color.z}) < 1.0;
    };
    const auto is_coloured = [](const LoadedMedium& medium) { return medium.mesh && medium.mesh->diffuse; };
    if (has_way_out || scene.settings.max_depth || scattering != SCATTERING_MULTIPLE ||
        std::any_of(media.begin(), media.end(), is_coloured) ||
        std::any_of(scene.surfaces.begin(), scene.surfaces.end(), absorbs))
        return;
    Rgb sigma_t(0.0), lost(0.0);
    for (std::size_t i = 0; i < media.size(); ++i) {
        const DensityField* field = media[i].field ? &*media[i].field : nullptr;
        sigma_t += world_sigma_t(scene.volumes[i], field);
        lost += lost_in(scene.volumes[i], least_map_albedo(scene.volumes[i]), field);
    }
    if (is_lossless(lost, sigma_t))
        throw InputError(
            "<periodic>: a domain that repeats along all axes and in which nothing absorbs keeps its paths "
            "for ever; leave out an axis, raise sigma_a, or give a <maxDepth>");
}

} // namespace vkvol
