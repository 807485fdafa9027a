#pragma once

#include "medium.h"
#include "rng.h"

namespace reference {

// An unbiased estimate of the transmittance from the ray's origin to infinity. Exact in a homogeneous medium, where rng
// is not used; else ratio tracking (Novak et al. 2014) with Russian roulette below the threshold (0: never).
double ratio_transmittance(const Medium& medium, const Ray& ray, Rng& rng, double roulette_threshold = 0.0);

} // namespace reference
