#include "first_flights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

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

// Chances of media by what they follow from, since instances have one grid.
class Chances {
public:
    double of(const Volume& volume, const LoadedMedium& loaded) {
        const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
        if (!loaded.field)
            return -std::expm1(-sigma_t * usual_share * diagonal_of(volume, loaded) / std::sqrt(3.0));
        std::array<double, 3> depths; // of cells, by axes
        for (int axis = 0; axis < 3; ++axis)
            depths[axis] = usual_share * sigma_t * loaded.majorants->cell *
                           glm::length(glm::dvec3(loaded.field->index_to_world[axis]));
        const auto [known, is_new] = known_.try_emplace({loaded.majorants.get(), depths}, 0.0);
        for (int axis = 0; axis < 3 && is_new; ++axis)
            known->second += chance_along(*loaded.majorants, axis, depths[axis]) / 3.0;
        return known->second;
    }

private:
    std::map<std::pair<const MajorantGrid*, std::array<double, 3>>, double> known_;
};

} // namespace

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
    // Roughly, that a ray which meets a grid's matter collides with it, mean over rays along the grid's axes; of other
    // media over such as cross them. Of several the largest.
    double chance = 0.0;
    Chances chances;
    for (std::size_t i = 0; i < scene.volumes.size() && chance < most; ++i)
        chance = std::max(chance, chances.of(scene.volumes[i], media[i]));
    return chance > least && chance < most && background <= chance * even;
}

} // namespace vkvol
