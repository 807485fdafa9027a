// A domain that repeats, as the kernels see it.
#pragma once

#include "loaded_medium.h"
#include "shared/frame.h"

namespace vkvol {

// All 0 where nothing repeats. `origin`: of render space, in the world.
shared::PeriodParams make_period(const Scene& scene, Media media, glm::dvec3 origin);

} // namespace vkvol
