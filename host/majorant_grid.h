// Upper bounds of the density, cell by cell: what delta and ratio tracking walk over.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "density_field.h"

namespace vkvol {

// Cells are cubes of `cell` voxels from `origin` on (index space, z fastest); together they cover the region where the
// interpolated density can differ from 0, one voxel beyond the active ones. Each bound is the largest voxel value
// among the corners that interpolation inside the cell, faces included, can touch: tight for trilinear lookup unless
// that value stands at a corner shared with a neighbour.
struct MajorantGrid {
    int cell = 8;
    glm::ivec3 origin{0};
    glm::ivec3 dims{0};
    std::vector<float> bounds;
};

// `cell` 0 chooses: 8 voxels, the size of a leaf, doubled until there are at most 2^24 cells.
MajorantGrid make_majorant_grid(const DensityField& field, int cell);

} // namespace vkvol
