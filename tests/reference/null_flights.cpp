#include <algorithm>
#include <cmath>

#include "cells.h"
#include "free_flight.h"

namespace reference {

using vkvol::Rgb;

namespace {

// Tentative collisions at the rate sigma_maj. decide(sigma_t, sigma_maj, u, beta) says whether the one at hand is real,
// from the extinction there and a uniform number, and weights beta for what it decides.
template <typename Decide>
Flight track(const Medium& medium, const Ray& ray, double exponential, Rgb beta, Rng& rng, const FlightEvents& events,
             const Decide& decide) {
    const DensityAlong density(medium, ray);
    CellWalk walk(medium, ray);
    Cell cell;
    double tau = exponential; // majorant optical depth left until the next tentative collision
    while (walk.next(cell)) {
        const double sigma_maj = medium.largest() * cell.majorant;
        if (sigma_maj == 0.0)
            continue;
        double t = cell.t0;
        while (t < cell.t1) {
            const double length = tau / sigma_maj;
            const bool collides = length < cell.t1 - t;
            if (events.piece)
                events.piece(t, collides ? t + length : cell.t1, beta);
            if (!collides) {
                tau -= sigma_maj * (cell.t1 - t);
                break;
            }
            t += length;
            const Draw draw = rng.next();
            const Rgb sigma_t = medium.sigma_t * density(t);
            if (events.tentative)
                events.tentative(t, beta * sigma_t / sigma_maj);
            if (decide(sigma_t, sigma_maj, draw.event(), beta))
                return {t, beta};
            if (beta == Rgb(0.0))
                return {{}, beta};
            tau = draw.exponential(0);
        }
    }
    return {{}, beta};
}

double largest(const Rgb& v) {
    return std::max({v.x, v.y, v.z});
}

} // namespace

Flight delta_flight(const Medium& medium, const Ray& ray, double exponential, const Rgb& beta, Rng& rng,
                    const FlightEvents& events) {
    const auto decide = [](const Rgb& sigma_t, double sigma_maj, double u, Rgb&) {
        return u * sigma_maj < largest(sigma_t);
    };
    return track(medium, ray, exponential, beta, rng, events, decide);
}

Flight weighted_flight(const Medium& medium, const Ray& ray, double exponential, const Rgb& beta, Rng& rng,
                       const FlightEvents& events) {
    const auto decide = [](const Rgb& sigma_t, double sigma_maj, double u, Rgb& weight) {
        const double s = largest(sigma_t), P = s / (s + std::abs(sigma_maj - s));
        const bool real = u < P;
        weight *= real ? s / (sigma_maj * P) : (sigma_maj - s) / (sigma_maj * (1.0 - P));
        return real;
    };
    return track(medium, ray, exponential, beta, rng, events, decide);
}

Flight spectral_flight(const Medium& medium, const Ray& ray, double exponential, const Rgb& beta, Rng& rng,
                       const FlightEvents& events) {
    const auto decide = [](const Rgb& sigma_t, double sigma_maj, double u, Rgb& weight) {
        const Rgb real_weight = weight * sigma_t, null_weight = weight * (sigma_maj - sigma_t);
        const double a = glm::dot(glm::abs(real_weight), Rgb(1.0)), n = glm::dot(glm::abs(null_weight), Rgb(1.0));
        if (a + n == 0.0) {
            weight = Rgb(0.0);
            return false;
        }
        const double P = a / (a + n);
        const bool real = u < P;
        weight = real ? real_weight / (sigma_maj * P) : null_weight / (sigma_maj * (1.0 - P));
        return real;
    };
    return track(medium, ray, exponential, beta, rng, events, decide);
}

} // namespace reference
