#include "path.h"

#include <stdexcept>

#include "camera.h"
#include "free_flight.h"
#include "phase.h"
#include "transmittance.h"

namespace reference {

using vkvol::Rgb;

namespace {

// Shadow rays lose their weight in dense media slowly; below this transmittance roulette ends most of them.
constexpr double shadow_roulette_threshold = 0.1;

// Radiance scattered into the path at p from all directional lights.
Rgb direct_light(const World& world, const glm::dvec3& p, const glm::dvec3& travel, Rng& rng) {
    const Medium& medium = *world.medium;
    Rgb Ld(0.0);
    for (const vkvol::DirectionalLight& light : world.scene.lights) {
        // Light travels along -light.direction and leaves along -travel: their cosine is dot(direction, travel).
        const double mu = glm::dot(light.direction, travel);
        const double T = ratio_transmittance(medium, {p, light.direction}, rng, shadow_roulette_threshold);
        Ld += medium.albedo * hg_eval(medium.g, mu) * T * light.irradiance;
    }
    return Ld;
}

} // namespace

World load_world(const vkvol::Scene& scene) {
    if (scene.volumes.size() > 1)
        throw std::runtime_error("the reference renders one volume");
    const std::string& name = scene.settings.integrator;
    if (!name.empty() && name != "deltaTracking" && name != "ratioTracking")
        throw std::runtime_error("the reference knows deltaTracking and ratioTracking, not " + name);

    World world{scene, std::nullopt, name == "ratioTracking" || (name.empty() && !scene.lights.empty())};
    if (!scene.volumes.empty())
        world.medium = load(scene.volumes.front(), scene.settings.filter);
    return world;
}

Rgb radiance(const World& world, Ray ray, double flight, Rng& rng) {
    const vkvol::RenderSettings& settings = world.scene.settings;
    Rgb L(0.0);
    double beta = 1.0; // throughput
    for (std::uint32_t depth = 0;; ++depth) {
        const auto t = world.medium ? sample_collision(*world.medium, ray, flight, rng) : std::nullopt;
        if (!t)
            return L + beta * world.scene.background;

        const Medium& medium = *world.medium;
        ray.origin = ray.at(*t);
        L += beta * (1.0 - medium.albedo) * medium.emission.at(ray.origin);
        if (settings.max_depth && depth == *settings.max_depth)
            return L;
        if (world.nee)
            L += beta * direct_light(world, ray.origin, ray.direction, rng);

        const Draw draw = rng.next();
        beta *= medium.albedo;
        if (beta < settings.roulette_threshold) {
            if (draw.w() * settings.roulette_threshold >= beta)
                return L;
            beta = settings.roulette_threshold;
        }
        if (beta == 0.0)
            return L;
        ray.direction = hg_sample(medium.g, ray.direction, draw.y(), draw.z());
        flight = to_exponential(draw.x());
    }
}

Rgb trace_path(const World& world, int x, int y, std::uint32_t sample, std::uint32_t seed) {
    Rng rng{static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << 16, sample, seed};
    const Draw draw = rng.next();
    const Ray ray = camera_ray(world.scene.camera, world.scene.picture, x + draw.x(), y + draw.y());
    return radiance(world, ray, to_exponential(draw.z()), rng);
}

} // namespace reference
