// Several media, by a race: each of them has a flight of its own, as if it were alone, and the nearest collision is
// that of the path. (Independent Poisson processes together are one, whose rate is their sum.) The renderer itself
// walks through bounds of that sum, and draws the medium where it collides: nothing of that is here.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "free_flight.h"
#include "path.h"
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
    run(*world.medium);
    for (const Medium& medium : world.others)
        run(medium);
    return nearest;
}

} // namespace

Rgb radiance_in_several(const World& world, Ray ray, Rng& rng) {
    const Method& method = world.method;
    const vkvol::RenderSettings& settings = world.scene.settings;
    Rgb L(0.0), beta(1.0);
    for (std::uint32_t depth = 0;; ++depth) {
        const bool last = method.scattering == SCATTERING_NONE || (settings.max_depth && depth == *settings.max_depth);
        const std::optional<Collision> collision = nearest_collision(world, ray, rng);
        if (!collision)
            return L + beta * light_from_beyond(world, ray.direction, depth == 0);
        const Medium& medium = *collision->medium;
        ray.origin = ray.at(collision->t);
        const Rgb albedo = medium.albedo_at(ray.origin);
        L += beta * (1.0 - albedo) * medium.emission.at(ray.origin);
        if (last)
            return L;
        beta *= albedo;
        if (method.nee != NEE_NONE)
            L += beta * direct_light(world, medium, ray.origin, ray.direction, rng);
        const Draw draw = rng.next();
        const double m = std::max({beta.x, beta.y, beta.z});
        if (method.scattering == SCATTERING_SINGLE || m == 0.0)
            return L;
        if (m < settings.roulette_threshold) {
            if (!(draw.w() * settings.roulette_threshold < m))
                return L;
            beta *= settings.roulette_threshold / m;
        }
        ray.direction = phase_sample(medium, ray.direction, draw.y(), draw.z());
    }
}

} // namespace reference
