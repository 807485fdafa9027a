// Ray marching straight through the medium: emission, and light scattered once, summed along the way.
#include <algorithm>
#include <cmath>

#include "cells.h"
#include "path.h"
#include "shaders/shared/constants.h"

namespace reference {

using vkvol::Rgb;

namespace {

constexpr double roulette_threshold = 1e-3;

} // namespace

bool marches_through(const Method& method) {
    const bool march = method.free_flight == FREE_FLIGHT_MARCH || method.free_flight == FREE_FLIGHT_ADAPTIVE;
    return (march && method.scattering != SCATTERING_MULTIPLE) ||
           (method.free_flight == FREE_FLIGHT_ANALYTIC && method.scattering == SCATTERING_NONE);
}

Rgb march_through(const World& world, const Ray& ray, Rng& rng) {
    const Medium& medium = *world.medium;
    const vkvol::March& march = world.method.march;
    const DensityAlong density(medium, ray);
    const bool lit = world.method.nee != NEE_NONE && world.scene.settings.max_depth.value_or(1) > 0;
    Rgb L(0.0), beta(1.0);

    const auto pass = [&](double t, double length) { // all that the step adds, but the light scattered in it
        const Rgb T = glm::exp(-medium.sigma_t * density(t) * length);
        const Rgb alpha = beta * (1.0 - T);
        L += alpha * (1.0 - medium.albedo_at(ray.at(t))) * medium.emission_at(ray.at(t));
        beta *= T;
        return alpha;
    };
    if (world.method.free_flight == FREE_FLIGHT_ANALYTIC) {
        for (const Interval& interval : support(medium, ray))
            pass(0.5 * (interval.t0 + interval.t1), interval.length());
        return world.scene.holds_out ? L : L + beta * light_from_beyond(world, ray.direction, true);
    }

    const Step step = [&](double t, double length) {
        const Draw draw = rng.next();
        const double point = t + (march.jitter ? draw.x() : 0.5) * length;
        const Rgb alpha = pass(point, length);
        if (lit && density(point) > 0.0)
            L += alpha * medium.albedo_at(ray.at(point)) *
                 direct_light(world, medium, ray.at(point), ray.direction, rng);
        const double m = std::max({beta.x, beta.y, beta.z});
        if (m < roulette_threshold) {
            if (!(draw.y() * roulette_threshold < m)) {
                beta = Rgb(0.0);
                return false;
            }
            beta *= roulette_threshold / m;
        }
        return true;
    };
    if (world.method.free_flight == FREE_FLIGHT_ADAPTIVE)
        for_each_adaptive_step(medium, ray, march.optical_step, step);
    else
        for_each_step(medium, ray, march.step, step);
    return world.scene.holds_out ? L : L + beta * light_from_beyond(world, ray.direction, true);
}

} // namespace reference
