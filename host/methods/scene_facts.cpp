#include "scene_facts.h"

#include <algorithm>

#include "estimator_traits.h"
#include "shared/constants.h"

namespace vkvol {

bool is_superposition(const Scene& scene) {
    return scene.volumes.size() > 1;
}

bool are_even_together(const Scene& scene) {
    const auto varies = [](const Volume& volume) {
        const bool is_plain = std::holds_alternative<Sphere>(volume.shape) ||
                              std::holds_alternative<Box>(volume.shape) || is_everywhere(volume);
        return !is_plain || volume.noise || volume.layers;
    };
    return is_superposition(scene) && scene.volumes.size() <= MOST_EVEN_MEDIA && !any_medium(scene, varies) &&
           !has_chromatic_extinction(scene);
}

bool sees_at_once(const Scene& scene) {
    const AxisChoices& choices = scene.settings.choices;
    return are_even_together(scene) &&
           (choices.transmittance ? transmittance_has(*choices.transmittance, TRAIT_CLOSED | TRAIT_VOXELS)
                                  : choices.nee != NEE_CACHED || !can_cache_light(scene));
}

int density_kind(const Scene& scene) {
    if (is_superposition(scene))
        return FIELD_SUPERPOSITION;
    int kind = FIELD_CONSTANT;
    for (const Volume& volume : scene.volumes) {
        const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
        kind = std::max(kind, is_grid         ? FIELD_GRID
                              : volume.layers ? FIELD_LAYERS
                              : volume.noise  ? FIELD_NOISE
                                              : FIELD_CONSTANT);
    }
    return kind;
}

bool can_scatter(const Volume& volume) {
    return volume.density_scale * volume.sigma_s * most_map_albedo(volume) != Rgb(0.0);
}

bool has_chromatic_extinction(const Scene& scene) {
    return any_medium(scene, [](const Volume& volume) {
        const Rgb sigma_t = volume.density_scale * (volume.sigma_a + volume.sigma_s);
        const double largest = std::max({sigma_t.x, sigma_t.y, sigma_t.z});
        const double smallest = std::min({sigma_t.x, sigma_t.y, sigma_t.z});
        return largest - smallest > 1e-9 * largest; // what sums of decimals differ by is rounding
    });
}

bool glows(const Volume& volume) {
    return volume.density_scale * most_sigma_a(volume) *
               (volume.Le + volume.temperature.color + most_map_emission(volume)) !=
           Rgb(0.0);
}

bool emits(const Scene& scene) {
    return any_medium(scene, glows);
}

bool can_cache_light(const Scene& scene) {
    const auto is_mesh = [](const Volume& volume) { return std::holds_alternative<MeshFiles>(volume.shape); };
    return !scene.lights.empty() && scene.surfaces.empty() && !scene.periodic &&
           density_kind(scene) != FIELD_CONSTANT && !any_medium(scene, is_mesh) && !any_medium(scene, is_everywhere);
}

bool has_map(const Scene& scene) {
    return any_medium(scene, [](const Volume& volume) { return volume.map.exists(); });
}

bool fades(const Scene& scene) {
    const Volume* volume = lone_volume(scene);
    return volume && volume->layers && volume->layers->scale_height > 0.0;
}

} // namespace vkvol
