// Estimators of the transmittance from a ray's origin to infinity, per channel.
#pragma once

#include "medium.h"
#include "rng.h"

namespace reference {

// Weights below this are thinned out by Russian roulette, at tentative collisions.
constexpr double shadow_roulette_threshold = 0.1;

// TRANSMITTANCE_... `march`: as resolved. All but analytic begin with one draw, used or not.
vkvol::Rgb estimate_transmittance(const Medium& medium, int estimator, const Ray& ray, const vkvol::March& march,
                                  Rng& rng);

vkvol::Rgb analytic_transmittance(const Medium& medium, const Ray& ray);
vkvol::Rgb march_transmittance(const Medium& medium, const Ray& ray, const vkvol::March& march, Rng& rng);

// Track-length estimator: does delta tracking get through?
vkvol::Rgb delta_transmittance(const Medium& medium, const Ray& ray, double exponential, Rng& rng);
// Ratio and residual ratio tracking: Novak et al. 2014.
vkvol::Rgb ratio_transmittance(const Medium& medium, const Ray& ray, double exponential, Rng& rng);
vkvol::Rgb residual_transmittance(const Medium& medium, const Ray& ray, double exponential, Rng& rng);

// Unbiased ray marching: Misso et al. 2022. A coarse march, corrected by the difference of a finer one, chosen at
// random, to the next coarser. Can be negative, or above 1.
vkvol::Rgb telescoping_transmittance(const Medium& medium, const Ray& ray, double step, const Draw& first);

} // namespace reference
