#include "transmittance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cells.h"
#include "quadrature.h"
#include "shaders/shared/constants.h"

namespace reference {

using vkvol::Rgb;

namespace {

double largest_size(const Rgb& T) {
    return std::max({std::abs(T.x), std::abs(T.y), std::abs(T.z)});
}

// Does the weight survive? Survivors make up for the others.
bool roulette(Rgb& T, double u) {
    const double m = largest_size(T);
    if (m < shadow_roulette_threshold) {
        if (!(u * shadow_roulette_threshold < m))
            return false;
        T *= shadow_roulette_threshold / m;
    }
    return true;
}

// Tentative collisions at the rate largest() * rate(cell); fly(T, cell, length) weights T for every length flown,
// collide(T, cell, rho, u) for a collision, and says whether any of T is left.
template <typename Rate, typename Fly, typename Collide>
Rgb track(const Medium& medium, const Ray& ray, double exponential, Rng& rng, const Rate& rate, const Fly& fly,
          const Collide& collide) {
    const DensityAlong density(medium, ray);
    CellWalk walk(medium, ray);
    Cell cell;
    Rgb T(1.0);
    double tau = exponential;
    while (walk.next(cell)) {
        const double sigma = medium.largest() * rate(cell);
        double t = cell.t0;
        while (tau < sigma * (cell.t1 - t)) {
            fly(T, cell, tau / sigma);
            t += tau / sigma;
            const Draw draw = rng.next();
            if (!collide(T, cell, density(t), draw.event()))
                return Rgb(0.0);
            tau = draw.exponential(0);
        }
        fly(T, cell, cell.t1 - t);
        tau -= sigma * (cell.t1 - t);
    }
    return T;
}

const auto majorant = [](const Cell& cell) { return cell.majorant; };
const auto residual = [](const Cell& cell) { return cell.residual; };
const auto unweighted = [](Rgb&, const Cell&, double) {};

} // namespace

Rgb analytic_transmittance(const Medium& medium, const Ray& ray) {
    if (!medium.homogeneous() && !medium.fades())
        throw std::runtime_error("analytic transmittance is for homogeneous media and exponentials");
    double length = 0.0;
    for (const Interval& interval : support(medium, ray))
        length += medium.fades() ? medium.fading_integral(ray, interval) : interval.length();
    return glm::exp(-medium.sigma_t * length);
}

Rgb march_transmittance(const Medium& medium, const Ray& ray, const vkvol::March& march, Rng& rng) {
    const DensityAlong density(medium, ray);
    double D = 0.0;
    for_each_step(medium, ray, march.shadow_step, [&](double t, double length) {
        const double offset = rng.next().x();
        D += length * density(t + (march.jitter ? offset : 0.5) * length);
        return true;
    });
    return glm::exp(-medium.sigma_t * D);
}

Rgb delta_transmittance(const Medium& medium, const Ray& ray, double exponential, Rng& rng) {
    return track(medium, ray, exponential, rng, majorant, unweighted,
                 [&](Rgb& T, const Cell& cell, double rho, double u) {
                     for (int i = 0; i < 3; ++i)
                         if (u * medium.largest() * cell.majorant < medium.sigma_t[i] * rho)
                             T[i] = 0.0;
                     return T != Rgb(0.0);
                 });
}

Rgb ratio_transmittance(const Medium& medium, const Ray& ray, double exponential, Rng& rng) {
    return track(medium, ray, exponential, rng, majorant, unweighted,
                 [&](Rgb& T, const Cell& cell, double rho, double u) {
                     T *= 1.0 - medium.sigma_t * rho / (medium.largest() * cell.majorant);
                     return roulette(T, u);
                 });
}

Rgb residual_transmittance(const Medium& medium, const Ray& ray, double exponential, Rng& rng) {
    const auto fly = [&](Rgb& T, const Cell& cell, double length) {
        T *= glm::exp(-medium.sigma_t * cell.control * length);
    };
    return track(medium, ray, exponential, rng, residual, fly, [&](Rgb& T, const Cell& cell, double rho, double u) {
        T *= 1.0 - medium.sigma_t * (rho - cell.control) / (medium.largest() * cell.residual);
        return roulette(T, u);
    });
}

Rgb telescoping_transmittance(const Medium& medium, const Ray& ray, double step, const Draw& first) {
    const double q = std::pow(2.0, -1.5); // finite variance and expected cost: error^2 falls by 4, cost rises by 2
    const int j = static_cast<int>(std::floor(std::log(1.0 - first.y()) / std::log(q)));
    const double probability = (1.0 - q) * std::pow(q, j);
    const int stride = 2 << j; // fine samples per one of the base
    const int residue = static_cast<int>(first.select() * stride);
    const DensityAlong density(medium, ray);
    double fine = 0.0, coarse = 0.0, base = 0.0;
    for (const Interval& interval : support(medium, ray)) {
        const int n = step_count(interval, step) * stride;
        const double length = interval.length() / n;
        for (int i = 0; i < n; ++i) {
            const double D = length * density(interval.t0 + (i + first.z()) * length);
            fine += D;
            if (i % 2 == residue % 2)
                coarse += 2.0 * D;
            if (i % stride == residue)
                base += stride * D;
        }
    }
    const auto T = [&](double D) { return glm::exp(-medium.sigma_t * D); };
    return T(base) + (T(fine) - T(coarse)) / probability;
}

// Two marches over the same steps; the jackknife removes what the variance of one adds to the mean of exp(-D).
Rgb jackknife_transmittance(const Medium& medium, const Ray& ray, double step, Rng& rng) {
    const DensityAlong density(medium, ray);
    double first = 0.0, second = 0.0;
    for (const Interval& interval : support(medium, ray)) {
        const int n = step_count(interval, step);
        const double length = interval.length() / n;
        for (int k = 0; k < n; ++k) {
            const Draw draw = rng.next();
            first += length * density(interval.t0 + (k + draw.x()) * length);
            second += length * density(interval.t0 + (k + draw.y()) * length);
        }
    }
    const auto T = [&](double D) { return glm::exp(-medium.sigma_t * D); };
    return 2.0 * T((first + second) / 2.0) - (T(first) + T(second)) / 2.0;
}

Rgb estimate_transmittance(const Medium& medium, int estimator, const Ray& ray, const vkvol::March& march, Rng& rng) {
    if (estimator == TRANSMITTANCE_ANALYTIC)
        return analytic_transmittance(medium, ray);
    const Draw first = rng.next();
    const double exponential = first.exponential(0);
    switch (estimator) {
    case TRANSMITTANCE_REGULAR:
        return glm::exp(-medium.sigma_t * density_integral(medium, ray));
    case TRANSMITTANCE_MARCH:
        return march_transmittance(medium, ray, march, rng);
    case TRANSMITTANCE_DELTA:
        return delta_transmittance(medium, ray, exponential, rng);
    case TRANSMITTANCE_RATIO:
        return ratio_transmittance(medium, ray, exponential, rng);
    case TRANSMITTANCE_RESIDUAL:
        return residual_transmittance(medium, ray, exponential, rng);
    case TRANSMITTANCE_TELESCOPING:
        return telescoping_transmittance(medium, ray, march.shadow_step, first);
    case TRANSMITTANCE_JACKKNIFE:
        return jackknife_transmittance(medium, ray, march.shadow_step, rng);
    }
    throw std::runtime_error("no such transmittance estimator");
}

} // namespace reference
