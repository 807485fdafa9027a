// Which scenes particles can render, and which they render best.
#pragma once

#include "scene.h"

namespace vkvol {

// From lights that are infinitely far: not where a plane or a medium is without end.
bool particles_come_from_afar(const Scene& scene);

// What they cannot do of the scene, `both`: together with paths from the camera; null if they can render it.
const char* why_no_particles(const Scene& scene, bool both, bool emits);

// Whether the sensor reads what particles alone leave, or most of what comes from afar into a domain that repeats
// passes the sensor, and may scatter before: then particles know its flux several times sooner than rays from the
// sensor do, see tools/results/README.md.
bool gains_by_particles(const Scene& scene);

} // namespace vkvol
