// Densities by height: their box, what they are between two heights, and cells across them.
#pragma once

#include <vector>

#include "majorant_grid.h"
#include "value_map.h"

namespace vkvol {

// Where a volume with layers is, before it is moved: its shape between their bottom and their top. World units.
struct LayerBox {
    glm::dvec3 low, size; // > 0, or there is nothing
};
LayerBox layer_box(const Volume& volume);

// The density at a height; 0 beyond the bottom and the top.
double layer_density(const Volume& volume, double height);

// Densities at all heights in [low, high], and what single precision may make of them.
DensityRange layer_range(const Volume& volume, double low, double high);

// Cells across the layers of a volume, in a space in which each is a cube of edge 1; the largest density of each.
MajorantGrid layer_cells(const Volume& volume);

// Control densities of these cells: the least, with the bound of what differs from it.
std::vector<shared::ControlCell> layer_controls(const Volume& volume);

} // namespace vkvol
