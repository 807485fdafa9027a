// Surfaces in the seams of a domain that repeats.
#pragma once

#include <vector>

#include "scene.h"

namespace vkvol {

// A ray that comes to a seam goes on from the face across: whether it met what lies in the seam, there or here, would
// be a matter of rounding. Moves it into the domain, by half as much again as rays are kept off it. A mesh's faces take
// their neighbours' corners along, as far as they share them. `origin`: of render space.
std::vector<Surface> kept_off_seams(const Periodic& periodic, const glm::dvec3& origin, std::vector<Surface> surfaces);

} // namespace vkvol
