// Empty space around empty majorant cells: what a walk crosses in one step.
#pragma once

#include <cstdint>
#include <vector>

#include "majorant_grid.h"

namespace vkvol {

// For each cell how many cells around it are empty like itself in every direction, beyond the grid too: all cells
// within that distance in the chessboard metric. 0 where the cell is not empty; 254 at most.
std::vector<std::uint8_t> empty_reaches(const MajorantGrid& cells);

// What kernels walk over: of each cell the bound of the density or, where that is 0 and the walk leaps, minus the
// reach.
std::vector<float> walked_cells(const MajorantGrid& cells);

} // namespace vkvol
