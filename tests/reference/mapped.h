// Maps of a grid's values, by their definition: interpolation between the points on either side.
#pragma once

#include <vector>

#include "scene.h"

namespace reference {

// Density, albedo and emission where the grid's value is this one. Without a map the value is the density.
vkvol::MapPoint mapped(const vkvol::ValueMap& map, double value);

struct Extremes {
    double least, most;
};

// Extremes of the densities that values in [low, high] are mapped to.
Extremes mapped_extremes(const vkvol::ValueMap& map, double low, double high);

// Where in (0, 1) the cubic through `samples`, values at 0, 1/3, 2/3 and 1, takes any of the points' values, in order:
// between these the density of what it is mapped to is a cubic as well.
std::vector<double> map_breaks(const vkvol::ValueMap& map, const double (&samples)[4]);

} // namespace reference
