#include "render_limits.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "error.h"
#include "layers.h"
#include "noise.h"
#include "shared/estimators.h"

namespace vkvol {

namespace {

// Per ray: at a million a second it takes ten seconds, and a pixel takes many.
constexpr double most_collisions = 1e7;
// As of other marches.
constexpr double most_steps = 1e6;
// Of the sigmas in world units, times the largest density.
constexpr double largest_extinction = 1e30;

// The medium's box as a camera meets it, world space.
struct Extent {
    glm::dvec3 center{0.0};
    double diagonal = 0.0;
};

// Of a shape, before its volume's transform, which makes it longer along some axis.
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
    if (method.free_flight == FREE_FLIGHT_ADAPTIVE && !(depth / optical_step <= most_steps))
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

// A path that never comes to an end would be followed for ever.
void check_everywhere(const Scene& scene, const Volume& volume, const LoadedMedium& loaded) {
    constexpr double thinnest = 1e-15; // whose mean free path is a hundred thousandth of the way to where it ends
    const double sigma_t = largest(world_sigma_t(volume, nullptr));
    if (sigma_t > 0.0 && sigma_t < thinnest)
        throw InputError(fmt::format("the extinction, {:.3g} per world unit, is too thin to be <everywhere>; expected "
                                     "at least {:g}, or a <box>",
                                     sigma_t, thinnest));
    const Rgb lost = volume.sigma_a + (Rgb(1.0) - most_map_albedo(volume)) * volume.sigma_s;
    const bool for_ever = std::min({lost.x, lost.y, lost.z}) < 1e-6 * largest(volume.sigma_a + volume.sigma_s);
    if (!loaded.is_layered && sigma_t > 0.0 && for_ever && !scene.settings.max_depth)
        throw InputError("a medium that is <everywhere> and absorbs nothing keeps its paths for ever; raise sigma_a, "
                         "or give a <maxDepth>");
}

void check_glow(const Volume& volume, const LoadedMedium& loaded) {
    const double most = hottest_radiance(volume, loaded);
    if (!(most <= brightest_light))
        throw InputError(fmt::format("<emission> reaches a radiance of {:.3g} where \"{}\" is hottest, but {:g} is the "
                                     "most; lower its multiplier or temperatureScale, or raise referenceTemperature",
                                     most, volume.temperature.grid, brightest_light));
}

} // namespace

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

void check_limits(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, const Method& method) {
    const bool empty_grid = std::holds_alternative<GridFile>(volume.shape) && !loaded.field;
    if (empty_grid)
        return;
    check_extinction(volume, loaded);
    if (is_everywhere(volume))
        return check_everywhere(scene, volume, loaded);
    const Extent extent = extent_of(volume, loaded);
    check_distance(scene, extent);
    const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    check_patience(scene, method, majorant_depth(scene, volume, loaded, extent.diagonal, sigma_t));
    check_glow(volume, loaded);
}

} // namespace vkvol
