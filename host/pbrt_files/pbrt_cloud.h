// The procedural clouds of pbrt-v4 ("cloud" of MakeNamedMedium).
#pragma once

#include <glm/glm.hpp>

namespace vkvol {

struct PbrtCloud {
    double density = 1.0, wispiness = 1.0, frequency = 5.0;

    // In [0, 1], at a point of the medium's space, y up: five octaves of Perlin's noise at a place that two more have
    // moved, less of it upwards, and full below y = 0.
    double at(const glm::dvec3& p) const;
};

} // namespace vkvol
