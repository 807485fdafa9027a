// A grid some time before or after its own: what is in it has gone on with its velocities.
#pragma once

#include "density_field.h"

namespace vkvol {

// Each voxel has what is now where its velocity came from, or comes to, in a straight line: the value at
// x - seconds * velocity(x), trilinear (a semi-Lagrangian step: Stam, "Stable Fluids", 1999; renderers of moving grids
// take the same). Where there is no velocity nothing moves. Throws InputError, without a place, if it goes thousands of
// voxels. `velocity`: of vectors, world units per second in the space in which the file has both; any transform. Of a
// quantised grid the result has floats. `goes_on`: beyond its box the grid is as at its faces, as albedos are, and
// keeps that box; others are 0 there, and their box may grow, but never shrinks.
DensityField drifted(const DensityField& field, const DensityField& velocity, double seconds, bool goes_on = false);

} // namespace vkvol
