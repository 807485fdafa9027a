// Walking over majorant cells along a ray.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "majorant_grid.h"

namespace vkvol {

// Calls visit(bound, t0, t1) for every cell that the ray passes within [0, length], until it returns false. Index
// space; the origin is in the cells' box or in its faces. With `reaches` (else it is empty) empty cells are passed
// together, as kernels do.
template <class Visit>
void walk_cells(const MajorantGrid& cells, const std::vector<std::uint8_t>& reaches, glm::dvec3 origin,
                glm::dvec3 direction, double length, const Visit& visit) {
    const glm::dvec3 from = (origin - glm::dvec3(cells.origin)) / double(cells.cell);
    const glm::dvec3 speed = direction / double(cells.cell);
    const glm::ivec3 side(glm::sign(direction));
    glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(from)), glm::ivec3(0), cells.dims - 1);
    for (double t = 0.0; t < length;) {
        const std::size_t i = (std::size_t(cell.x) * cells.dims.y + cell.y) * cells.dims.z + cell.z;
        const glm::ivec3 last = cell + (reaches.empty() ? 0 : int(reaches[i])) * side;
        int axis = 0;
        double exit = std::numeric_limits<double>::infinity();
        for (int a = 0; a < 3; ++a) {
            const double face = side[a] > 0 ? last[a] + 1.0 : last[a];
            const double at = side[a] != 0 ? (face - from[a]) / speed[a] : exit;
            if (at < exit) {
                exit = at;
                axis = a;
            }
        }
        exit = std::clamp(exit, t, length);
        if (!visit(cells.bounds[i], t, exit))
            return;
        const glm::ivec3 there(glm::floor(from + exit * speed));
        const glm::ivec3 most = glm::clamp(last, glm::ivec3(0), cells.dims - 1);
        cell = glm::clamp(there, glm::min(cell, most), glm::max(cell, most));
        cell[axis] = last[axis] + side[axis];
        if (cell != glm::clamp(cell, glm::ivec3(0), cells.dims - 1))
            return;
        t = exit;
    }
}

} // namespace vkvol
