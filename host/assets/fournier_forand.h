// The phase function of particles in water.
#pragma once

#include <vector>

#include "shared/frame.h"

namespace vkvol {

// Fournier and Forand's ("Analytic phase function for ocean water", 1994), of particles whose numbers fall with a power
// of their size: by their refractive index relative to water's, from 1.001 to 1.6, and the part of the light that they
// scatter backward, above 0 and below 1/2, which is stated instead of the power (Mobley, Sundman and Boss, "Phase
// function effects on oceanic light fields", 2002). Linear in the cosine between nodes: within 2e-4 of the closed form.
// That has no bound towards 0; what it scatters by less than 4.5e-5 radians is spread over these, linearly.
std::vector<shared::PhaseNode> fournier_forand_nodes(double index, double backscatter);

} // namespace vkvol
