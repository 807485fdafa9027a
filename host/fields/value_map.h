// Maps from the values of a grid to densities and colours: what they make of a value, of all values in an interval, and
// the tables that kernels search.
#pragma once

#include <vector>

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

// The density at a value >= 0: without a map the value itself.
double mapped_density(const ValueMap& map, double value);

struct DensityRange {
    double least = 0.0, most = 0.0;
};

// What all values in [low, high] are mapped to, and what single precision may make of their interpolation: 1e-6 of
// them, which is ten roundings. Between the interval's ends a map that is linear by pieces has its extrema at its
// points.
DensityRange mapped_range(const ValueMap& map, double low, double high);

// What tells it from others; none without a map.
std::vector<double> numbers_of(const ValueMap& map);

// The map as shaders/field/value_map.glsl reads it: 2^n knots, n >= 1. Empty without a map.
std::vector<shared::MapKnot> make_knots(const ValueMap& map);

// As many knots as `count`, a power of two that is not less.
void pad_knots(std::vector<shared::MapKnot>& knots, std::size_t count);

} // namespace vkvol
