// Surfaces in the seams of a domain that repeats.
#pragma once

#include <vector>

#include "scene.h"

namespace vkvol {

// A ray that comes to a seam goes on from the face across: whether it met what lies in the seam, there or here, would
// be a matter of rounding. Moves it into the domain, by no more than rays are kept off surfaces anyway. A mesh's faces
// take their neighbours' corners along, as far as they share them.
void keep_off_seams(const Periodic& periodic, std::vector<Surface>& surfaces);

} // namespace vkvol
