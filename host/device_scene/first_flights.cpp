#include "first_flights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "medium_pieces.h"
#include "placement.h"
#include "scene_facts.h"

namespace vkvol {

namespace {

constexpr double usual_share = 0.5; // of a bound, that densities have

// Mean over the columns of cells along an axis that are not empty. `depth`: optical depth of a cell of bound 1.
double chance_along(const MajorantGrid& cells, int axis, double depth) {
    const glm::ivec3 strides{cells.dims.y * cells.dims.z, cells.dims.z, 1};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double sum = 0.0, columns = 0.0;
    for (int i = 0; i < cells.dims[u]; ++i)
        for (int j = 0; j < cells.dims[v]; ++j) {
            double bounds = 0.0;
            for (int k = 0; k < cells.dims[axis]; ++k)
                bounds += cells.bounds[std::size_t(i) * strides[u] + std::size_t(j) * strides[v] +
                                       std::size_t(k) * strides[axis]];
            sum += -std::expm1(-depth * bounds);
            columns += bounds > 0.0;
        }
    return columns > 0.0 ? sum / columns : 0.0;
}

// Radiance of what scatters all of it evenly, of lights that are infinitely far.
double even_light(const Scene& scene) {
    double fluence = 0.0;
    for (const Light& light : scene.lights)
        if (const auto* far = std::get_if<DirectionalLight>(&light))
            fluence += largest(far->irradiance);
        else if (const auto* sun = std::get_if<SunLight>(&light))
            fluence += largest(sun->irradiance);
    return fluence / (4.0 * std::numbers::pi);
}

} // namespace

double chance_to_collide(const Volume& volume, const LoadedMedium& loaded) {
    const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    if (!loaded.field)
        return -std::expm1(-sigma_t * usual_share * diagonal_of(volume, loaded) / std::sqrt(3.0));
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double edge = loaded.majorants->cell * glm::length(glm::dvec3(loaded.field->index_to_world[axis]));
        sum += chance_along(*loaded.majorants, axis, usual_share * sigma_t * edge);
    }
    return sum / 3.0;
}

bool gains_by_split_flights(const Scene& scene, Media media) {
    constexpr double most = 0.75;  // measured: tools/results/README.md
    constexpr double least = 1e-4; // thinner ones are mostly meant otherwise: black pictures are explained
    const auto is_map = [](const Light& light) { return std::holds_alternative<SkyLight>(light); };
    const bool has_sky = std::any_of(scene.lights.begin(), scene.lights.end(), is_map);
    if (scene.volumes.empty() || !scene.surfaces.empty() || has_sky || any_medium(scene, is_everywhere))
        return false;
    const double even = even_light(scene), background = largest(scene.background);
    if (background > even) // whatever the chance, for which all cells are asked
        return false;
    double chance = 0.0;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        chance = std::max(chance, chance_to_collide(scene.volumes[i], media[i]));
    return chance > least && chance < most && background <= chance * even;
}

} // namespace vkvol
