// Upper bounds of the density, cell by cell: what null-collision estimators walk over; and control densities.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "density_field.h"
#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

struct PilotScene;

// Cells are cubes of `cell` voxels from `origin` on (index space, z fastest); together they cover the region where the
// interpolated density can differ from 0, one voxel beyond the active ones. Each bound is the largest voxel value
// among the corners that interpolation inside the cell, faces included, can touch: tight for trilinear lookup unless
// that value stands at a corner shared with a neighbour. Where values are mapped to densities, it is the most that the
// map has between the least and the largest of these values.
struct MajorantGrid {
    int cell = 8;
    glm::ivec3 origin{0};
    glm::ivec3 dims{0};
    std::vector<float> bounds;
    bool leaps = false;                  // walks pass empty cells together, see empty_space.h
    std::vector<double> segment_steps{}; // those expected of each of the pilot's flights and shadow rays
};

// `cell` voxels along an edge, > 0. More than 2^24 cells are never made.
MajorantGrid make_majorant_grid(const DensityField& field, int cell, const ValueMap& map = {});

// Cells of twice the edge.
MajorantGrid merge_cells(const MajorantGrid& fine);

// What a step costs that minds the room around empty cells, to one that does not.
constexpr double leap_cost = 1.08; // measured on llvmpipe: a thin medium without empty cells

// Among cells of 4, 8 ... 64 voxels, or of `cell` if that is not 0, with leaps or without, those over which paths of
// this scene take the least time: the fewest steps (after Yue et al., "Toward Optimal Space Partitioning for Unbiased,
// Adaptive Free Path Sampling", 2011; but along paths, not over the grid's box: they stay where the medium is thin, or
// near its surface where it is dense).
MajorantGrid choose_majorant_grid(const DensityField& field, const PilotScene& scene, int cell = 0);

// A control density for each cell of `grid` (whose bounds are the densities' own, not scaled), with the bound of what
// the density differs from it: the least value in the cell, or, where the rest would be optically thin across the whole
// grid, the mean (Novak et al., "Residual Ratio Tracking", 2014). A control c that the density s may be below makes
// weights that grow exponentially: their mean square exceeds the transmittance's by exp of the integral of (s - c)^2 /
// rest. `sigma_t`: extinction at density 1 per voxel; 0: the least value everywhere, a lower bound.
std::vector<shared::ControlCell> make_controls(const DensityField& field, const MajorantGrid& grid, double sigma_t,
                                               const ValueMap& map = {});

} // namespace vkvol
