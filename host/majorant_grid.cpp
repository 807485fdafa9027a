#include "majorant_grid.h"

#include <algorithm>
#include <numeric>

namespace vkvol {

namespace {

constexpr std::int64_t most_cells = std::int64_t{1} << 24;

glm::ivec3 cell_dims(const DensityField& field, int cell) {
    const glm::ivec3 extent = field.voxel_max - field.voxel_min + 2;
    return (extent + (cell - 1)) / cell;
}

std::int64_t count(glm::ivec3 dims) {
    return std::int64_t{dims.x} * dims.y * dims.z;
}

// Raises the bounds of every cell that the voxel at `relative` (to the grid's origin) is a corner of.
void raise(MajorantGrid& grid, glm::ivec3 relative, float value) {
    const glm::ivec3 high = glm::min(relative / grid.cell, grid.dims - 1);
    // A voxel on a face between cells is a corner of both.
    const glm::ivec3 low = glm::max((relative - 1) / grid.cell, glm::ivec3(0));
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z) {
                float& bound = grid.bounds[(std::size_t(x) * grid.dims.y + y) * grid.dims.z + z];
                bound = std::max(bound, value);
            }
}

// All voxels of the 8^3 block at `first`. Tiles of value 0 are most of a sparse grid and cost one look.
void raise_block(MajorantGrid& grid, const DensityField& field, glm::ivec3 first) {
    if (field.is_empty_block(first))
        return;
    const glm::ivec3 low = glm::max(first, field.voxel_min);
    const glm::ivec3 high = glm::min(first + 7, field.voxel_max);
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z)
                if (const float value = field.value({x, y, z}); value > 0.0f)
                    raise(grid, glm::ivec3(x, y, z) - grid.origin, value);
}

MajorantGrid build(const DensityField& field, int cell) {
    MajorantGrid grid;
    grid.cell = cell;
    while (count(cell_dims(field, grid.cell)) > most_cells)
        grid.cell *= 2;
    grid.origin = field.voxel_min - 1;
    grid.dims = cell_dims(field, grid.cell);
    grid.bounds.assign(static_cast<std::size_t>(count(grid.dims)), 0.0f);
    glm::ivec3 block;
    for (block.x = 0; block.x < field.leaf_dims.x; ++block.x)
        for (block.y = 0; block.y < field.leaf_dims.y; ++block.y)
            for (block.z = 0; block.z < field.leaf_dims.z; ++block.z)
                raise_block(grid, field, (field.leaf_min + block) * 8);
    return grid;
}

// Cells of twice the edge. The corners of a large cell are those of the eight it is made of.
MajorantGrid merge_cells(const MajorantGrid& fine) {
    MajorantGrid coarse;
    coarse.cell = 2 * fine.cell;
    coarse.origin = fine.origin;
    coarse.dims = (fine.dims + 1) / 2;
    coarse.bounds.assign(static_cast<std::size_t>(count(coarse.dims)), 0.0f);
    std::size_t i = 0;
    for (int x = 0; x < fine.dims.x; ++x)
        for (int y = 0; y < fine.dims.y; ++y)
            for (int z = 0; z < fine.dims.z; ++z) {
                float& bound = coarse.bounds[(std::size_t(x / 2) * coarse.dims.y + y / 2) * coarse.dims.z + z / 2];
                bound = std::max(bound, fine.bounds[i++]);
            }
    return coarse;
}

// Steps per voxel of a ray's length, averaged over the grid's box and all directions: a ray meets a face every
// cell / 1.5 voxels, 1.5 being the mean of |x| + |y| + |z| over unit vectors.
double steps_per_voxel(const MajorantGrid& grid, double sigma_t) {
    const double sum = std::accumulate(grid.bounds.begin(), grid.bounds.end(), 0.0);
    return sigma_t * sum / static_cast<double>(grid.bounds.size()) + 1.5 / grid.cell;
}

} // namespace

MajorantGrid make_majorant_grid(const DensityField& field, int cell, double sigma_t) {
    if (cell > 0)
        return build(field, cell);
    MajorantGrid best = build(field, 4);
    for (MajorantGrid next = merge_cells(best); next.cell <= 64; next = merge_cells(next))
        if (steps_per_voxel(next, sigma_t) < steps_per_voxel(best, sigma_t))
            best = next;
    return best;
}

} // namespace vkvol
