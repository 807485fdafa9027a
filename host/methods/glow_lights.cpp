#include "glow_lights.h"

#include <algorithm>

namespace vkvol {

namespace {

// Power per volume, solid angle and channel.
Rgb even_glow(const Volume& volume) {
    return volume.density_scale * volume.sigma_a * volume.Le;
}

// Of a grid or noise, points of the box about it would mostly lie where little glows, or behind what does.
bool can_be_light(const Volume& volume) {
    const bool is_even = !volume.noise && !volume.layers && !volume.map.exists() &&
                         volume.temperature.color == Rgb(0.0) && volume.albedo_grid.empty();
    const bool has_ends = std::holds_alternative<Sphere>(volume.shape) || std::holds_alternative<Box>(volume.shape);
    return is_even && has_ends && even_glow(volume) != Rgb(0.0);
}

bool is_glow(const Light& light) {
    return std::holds_alternative<GlowLight>(light);
}

} // namespace

bool has_lights_of_glow(const Scene& scene) {
    // Where a domain repeats each has them, and looks would find those of one.
    const bool lights_others = scene.volumes.size() > 1 || !scene.surfaces.empty();
    return lights_others && !scene.periodic && any_medium(scene, can_be_light);
}

Scene with_lights_of_glow(Scene scene) {
    if (!has_lights_of_glow(scene) || std::any_of(scene.lights.begin(), scene.lights.end(), is_glow))
        return scene;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (can_be_light(scene.volumes[i]))
            scene.lights.push_back(GlowLight{even_glow(scene.volumes[i]), "", static_cast<int>(i)});
    return scene;
}

Scene without_lights_of_glow(Scene scene) {
    std::erase_if(scene.lights, is_glow);
    return scene;
}

} // namespace vkvol
