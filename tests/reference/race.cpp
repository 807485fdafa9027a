// Several media, and surfaces, by a race: each medium has a flight of its own, as if it were alone, and the nearest
// collision, or the surface if that is nearer, is that of the path. (Independent Poisson processes together are one,
// whose rate is their sum.) The renderer itself walks through bounds of that sum, and draws the medium where it
// collides: nothing of that is here.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "free_flight.h"
#include "path.h"
#include "reference_surfaces.h"
#include "shaders/shared/constants.h"

namespace reference {

using vkvol::Rgb;

namespace {

struct Collision {
    double t;
    const Medium* medium;
};

std::optional<Collision> nearest_collision(const World& world, const Ray& ray, Rng& rng) {
    std::optional<Collision> nearest;
    const auto run = [&](const Medium& medium) {
        const Draw draw = rng.next();
        const Flight flight =
            fly(medium, FREE_FLIGHT_DELTA, ray, draw.exponential(0), draw.select(), Rgb(1.0), world.method.march, rng);
        if (flight.t && (!nearest || *flight.t < nearest->t))
            nearest = {*flight.t, &medium};
    };
    if (world.medium)
        run(*world.medium);
    for (const Medium& medium : world.others)
        run(medium);
    return nearest;
}

// Light from all lights that a surface scatters along -travel, per unit of throughput, flights aside.
Rgb light_on(const World& world, const SurfaceHit& hit, const glm::dvec3& p, const glm::dvec3& travel, Rng& rng) {
    Rgb Ld(0.0);
    for (const vkvol::Light& light : world.scene.lights) {
        const Draw draw = rng.next();
        if (const auto found = towards(light, p, draw.x(), draw.y()))
            Ld += scatter_value(hit, travel, found->ray.direction, rng) * transmittance(world, found->ray, rng) *
                  found->light;
    }
    return Ld;
}

// Roulette; false: the path is over.
bool survives(const vkvol::RenderSettings& settings, double u, Rgb& beta) {
    const double m = std::max({beta.x, beta.y, beta.z});
    if (m == 0.0)
        return false;
    if (m >= settings.roulette_threshold)
        return true;
    beta *= settings.roulette_threshold / m;
    return u * settings.roulette_threshold < m;
}

} // namespace

Rgb radiance_by_race(const World& world, Ray ray, Rng& rng) {
    const Method& method = world.method;
    const vkvol::RenderSettings& settings = world.scene.settings;
    Rgb L(0.0), beta(1.0);
    bool sees_all = true; // as the camera, and mirrors, do
    for (std::uint32_t depth = 0;; ++depth) {
        const bool last = method.scattering == SCATTERING_NONE || (settings.max_depth && depth == *settings.max_depth);
        const std::optional<SurfaceHit> hit = nearest_surface(world.scene.surfaces, ray);
        const std::optional<Collision> collision = nearest_collision(world, ray, rng);
        if (sees_all && depth > 0)
            L += beta * lamps_seen(world, ray, rng);
        if (!collision && !hit && depth == 0 && world.scene.holds_out)
            return L;
        if (!collision && !hit)
            return L + beta * light_from_beyond(world, ray.direction, sees_all);
        const bool collides = collision && !(hit && hit->t < collision->t);
        const glm::dvec3 travel = ray.direction;
        ray.origin = ray.at(collides ? collision->t : hit->t);
        if (collides) {
            const Rgb albedo = collision->medium->albedo_at(ray.origin);
            L += beta * (1.0 - albedo) * collision->medium->emission_at(ray.origin);
            beta *= albedo;
        } else if (hit->surface->shines_both_ways || glm::dot(hit->normal, travel) < 0.0) {
            L += beta * hit->surface->emission;
        }
        if (last)
            return L;
        if (method.nee != NEE_NONE)
            L += beta * (collides ? direct_light(world, *collision->medium, ray.origin, travel, rng)
                                  : light_on(world, *hit, ray.origin, travel, rng));
        if (method.scattering == SCATTERING_SINGLE)
            return L;
        const Draw draw = rng.next();
        sees_all = false;
        if (collides) {
            ray.direction = phase_sample(*collision->medium, travel, draw.y(), draw.z());
        } else {
            const Scattered next = scatter(*hit, travel, draw, rng);
            ray.direction = next.direction;
            beta *= next.weight;
            const bool stays_within =
                glm::dot(hit->normal, travel) > 0.0 && glm::dot(hit->normal, next.direction) < 0.0;
            if (stays_within && depth > 20 && settings.roulette_threshold > 0.0) { // glass may keep it for ever
                if (rng.next().x() < 0.2)
                    return L;
                beta /= 0.8;
            }
            sees_all = next.specular;
        }
        if (!survives(settings, draw.w(), beta))
            return L;
    }
}

} // namespace reference
