// By how much rays are kept off surfaces, and when that is to be seen.
#pragma once

#include <string>

#include "loaded_medium.h"
#include "scene.h"

namespace vkvol {

// A ray that leaves a surface begins SURFACE_SPARE of its distance from `origin`, render space's, off it: far from
// there, so far that what lies in between is lost. A warning of the surface that this does most to, where it is a
// hundredth of the surface's own size or of a mean free path of a medium there; else empty. `scene`: with its
// surfaces' files.
std::string surface_gap_warning(const Scene& scene, const Assets& assets, const glm::dvec3& origin);

} // namespace vkvol
