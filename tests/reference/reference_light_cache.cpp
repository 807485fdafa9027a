#include "reference_light_cache.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phase.h"
#include "transmittance.h"

namespace reference {

using vkvol::Rgb;

Rgb rough_transmittance(const Medium& medium, const Ray& ray) {
    constexpr int steps = 12;
    const DensityAlong density(medium, ray);
    double depth = 0.0;
    for (const Interval& part : support(medium, ray))
        for (int i = 0; i < steps; ++i) {
            const double dt = (part.t1 - part.t0) / steps;
            depth += density(part.t0 + (i + 0.5) * dt) * dt;
        }
    return glm::exp(-medium.sigma_t * depth);
}

Rgb cached_light(const World& world, const glm::dvec3& p, const glm::dvec3& travel, const Rgb& beta, Rng& rng) {
    const Medium& medium = *world.medium;
    Rgb Ld(0.0);
    {
        const vkvol::DirectionalLight& light = *vkvol::only_directional(world.scene.lights);
        const Ray ray{p, light.direction};
        const double phase = phase_eval(medium, glm::dot(light.direction, travel));
        const Rgb known = rough_transmittance(medium, ray);
        Ld += phase * known * light.irradiance;
        const double share = 4.0 * std::numbers::pi * phase * std::max({beta.x, beta.y, beta.z});
        const double t = std::max({known.x, known.y, known.z});
        const double chance = std::clamp(4.0 * share * (std::sqrt(t * (1.0 - t)) + 0.02), 0.05, 1.0);
        if (rng.next().x() < chance) {
            const Rgb T = estimate_transmittance(medium, world.method.transmittance, ray, world.method.march, rng);
            Ld += phase * (T - known) / chance * light.irradiance;
        }
    }
    return Ld;
}

Rgb foreseen_light(const World& world, const glm::dvec3& p, const glm::dvec3& before, const glm::dvec3& after) {
    const Medium& medium = *world.medium;
    Rgb foreseen(0.0);
    if (has_phase_twice(medium)) {
        const vkvol::DirectionalLight& light = *vkvol::only_directional(world.scene.lights);
        const Rgb T = rough_transmittance(medium, {p, light.direction});
        const double drawn = phase_eval(medium, glm::dot(light.direction, after));
        const double average = phase_eval_twice(medium, glm::dot(light.direction, before));
        for (int c = 0; c < 3; ++c)
            if (T[c] > 0.0)
                foreseen[c] -= T[c] * std::log(T[c]) * (drawn - average) * medium.albedo[c] * light.irradiance[c];
    }
    return foreseen;
}

} // namespace reference
