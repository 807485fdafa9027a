#pragma once

#include <optional>

#include "medium.h"
#include "rng.h"

namespace reference {

// The distance of the first real collision, or none if the ray leaves the medium. `flight` is a unit exponential
// variate for the first tentative collision. Analytic in a homogeneous medium, where rng is not used; else delta
// tracking (Woodcock 1965), one draw per tentative collision.
std::optional<double> sample_collision(const Medium& medium, const Ray& ray, double flight, Rng& rng);

} // namespace reference
