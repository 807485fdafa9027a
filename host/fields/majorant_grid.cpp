#include "majorant_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "pilot_paths.h"
#include "value_map.h"

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

// Of two values the one that a bound is, from above or from below.
float greater(float a, float b) {
    return std::max(a, b);
}
float lesser(float a, float b) {
    return std::min(a, b);
}
using Bound = float (*)(float, float);

// Moves `bounds` of every cell that a voxel from `first` to `last` (relative to the grid's origin) is a corner of.
template <Bound bound_of>
void move_bounds(const MajorantGrid& grid, std::vector<float>& bounds, glm::ivec3 first, glm::ivec3 last, float value) {
    const glm::ivec3 high = glm::min(last / grid.cell, grid.dims - 1);
    // A voxel on a face between cells is a corner of both.
    const glm::ivec3 low = glm::max((first - 1) / grid.cell, glm::ivec3(0));
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z) {
                float& bound = bounds[(std::size_t(x) * grid.dims.y + y) * grid.dims.z + z];
                bound = bound_of(bound, value);
            }
}

// The cells along an axis that a voxel is a corner of: on a face between two, both.
struct CellRange {
    int low, high;
};

CellRange cells_of_corner(const MajorantGrid& grid, int axis, int voxel) {
    return {std::max((voxel - 1) / grid.cell, 0), std::min(voxel / grid.cell, grid.dims[axis] - 1)};
}

// All voxels of a block, row by row. Tiles of value 0 are most of a sparse grid and, for bounds from above, cost one
// look, other tiles little more.
template <Bound bound_of>
void move_bounds(const MajorantGrid& grid, std::vector<float>& bounds, const DensityField& field, glm::ivec3 block) {
    const auto [low, high, constant] = field.block(block);
    if (constant) {
        if (*constant > 0.0f || bound_of == lesser)
            move_bounds<bound_of>(grid, bounds, low - grid.origin, high - grid.origin, *constant);
        return;
    }
    std::array<std::array<CellRange, 8>, 3> cells;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i <= high[axis] - low[axis]; ++i)
            cells[axis][i] = cells_of_corner(grid, axis, low[axis] + i - grid.origin[axis]);
    const int first = cells[2][0].low, last = cells[2][high.z - low.z].high;
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y) {
            const std::array<float, 8> row = field.row({x, y, low.z});
            std::array<float, 9> of_row; // cells along it: no more than there are voxels, and one
            of_row.fill(bound_of == lesser ? std::numeric_limits<float>::infinity() : 0.0f);
            for (int z = 0; z <= high.z - low.z; ++z)
                for (int c = cells[2][z].low; c <= cells[2][z].high; ++c)
                    of_row[c - first] = bound_of(of_row[c - first], row[z]);
            for (int i = cells[0][x - low.x].low; i <= cells[0][x - low.x].high; ++i)
                for (int j = cells[1][y - low.y].low; j <= cells[1][y - low.y].high; ++j) {
                    float* const there = &bounds[(std::size_t(i) * grid.dims.y + j) * grid.dims.z + first];
                    for (int c = 0; c <= last - first; ++c)
                        there[c] = bound_of(there[c], of_row[c]);
                }
        }
}

// Of every block.
template <Bound bound_of>
void move_bounds(const MajorantGrid& grid, std::vector<float>& bounds, const DensityField& field) {
    glm::ivec3 block;
    for (block.x = 0; block.x < field.leaf_dims.x; ++block.x)
        for (block.y = 0; block.y < field.leaf_dims.y; ++block.y)
            for (block.z = 0; block.z < field.leaf_dims.z; ++block.z)
                move_bounds<bound_of>(grid, bounds, field, block);
}

struct CellDensities {
    double least = 0.0, most = 0.0, mean = 0.0;
};

// Densities of all interpolation inside the cell; the mean is that of its corners.
CellDensities cell_densities(const DensityField& field, const ValueMap& map, const MajorantGrid& grid,
                             glm::ivec3 cell) {
    const glm::ivec3 low = grid.origin + cell * grid.cell;
    const glm::ivec3 high = glm::min(low + grid.cell, field.voxel_max + 1);
    double least = 1e300, most = 0.0, sum = 0.0;
    int corners = 0;
    for (int x = low.x; x <= high.x; ++x)
        for (int y = low.y; y <= high.y; ++y)
            for (int z = low.z; z <= high.z; ++z, ++corners) {
                const glm::ivec3 voxel(x, y, z);
                const bool active = voxel == glm::clamp(voxel, field.voxel_min, field.voxel_max);
                const double value = active ? field.value(voxel) : 0.0;
                least = std::min(least, value);
                most = std::max(most, value);
                sum += mapped_density(map, value);
            }
    const DensityRange range = mapped_range(map, least, most);
    return {range.least, range.most, sum / corners};
}

// Bounds of values become those of densities: of all that lies between the least and the most of a cell's corners,
// which are 0 beyond the voxels that there are.
void map_bounds(const DensityField& field, const ValueMap& map, MajorantGrid& grid) {
    std::vector<float> least(grid.bounds.size(), std::numeric_limits<float>::infinity());
    move_bounds<lesser>(grid, least, field);
    const glm::ivec3 end = field.voxel_max - grid.origin; // the last voxel's place
    std::size_t i = 0;
    for (int x = 0; x < grid.dims.x; ++x)
        for (int y = 0; y < grid.dims.y; ++y)
            for (int z = 0; z < grid.dims.z; ++z, ++i) {
                const glm::ivec3 cell(x, y, z), beyond = cell * grid.cell + grid.cell;
                const bool at_edge = x == 0 || y == 0 || z == 0 || glm::any(glm::greaterThan(beyond, end));
                const double from = at_edge ? std::min(least[i], 0.0f) : least[i];
                grid.bounds[i] = static_cast<float>(mapped_range(map, from, grid.bounds[i]).most);
            }
}

} // namespace

MajorantGrid make_majorant_grid(const DensityField& field, int cell, const ValueMap& map) {
    MajorantGrid grid;
    grid.cell = cell;
    while (count(cell_dims(field, grid.cell)) > most_cells)
        grid.cell *= 2;
    grid.origin = field.voxel_min - 1;
    grid.dims = cell_dims(field, grid.cell);
    grid.bounds.assign(static_cast<std::size_t>(count(grid.dims)), 0.0f);
    move_bounds<greater>(grid, grid.bounds, field);
    if (map.exists())
        map_bounds(field, map, grid);
    return grid;
}

// The corners of a large cell are those of the eight it is made of.
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

MajorantGrid choose_majorant_grid(const DensityField& field, const PilotScene& scene, int cell) {
    MajorantGrid grid = make_majorant_grid(field, cell > 0 ? cell : 4, scene.map), best = grid;
    const std::vector<PilotSegment> segments = pilot_paths(field, grid, scene);
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](bool leaps) {
        grid.leaps = leaps;
        const std::vector<double> steps = pilot_steps(segments, grid, scene.sigma_t);
        const double cost = std::accumulate(steps.begin(), steps.end(), 0.0) * (leaps ? leap_cost : 1.0);
        if (cost >= least)
            return;
        least = cost;
        best = grid;
        best.segment_steps = steps;
    };
    const auto consider_both = [&] {
        consider(false);
        if (scene.leaps)
            consider(true);
    };
    consider_both();
    while (cell == 0 && grid.cell < 64) {
        grid = merge_cells(grid);
        consider_both();
    }
    return best;
}

std::vector<shared::ControlCell> make_controls(const DensityField& field, const MajorantGrid& grid, double sigma_t,
                                               const ValueMap& map) {
    constexpr double rounding = 1e-6; // of the bounds, so that single precision does not violate them
    std::vector<shared::ControlCell> controls(grid.bounds.size(), shared::ControlCell{0.0f, 0.0f});
    const double across = sigma_t * grid.cell * glm::length(glm::dvec3(grid.dims));
    std::size_t i = 0;
    for (int x = 0; x < grid.dims.x; ++x)
        for (int y = 0; y < grid.dims.y; ++y)
            for (int z = 0; z < grid.dims.z; ++z, ++i) {
                const double most = grid.bounds[i];
                if (most == 0.0)
                    continue;
                const CellDensities values = cell_densities(field, map, grid, {x, y, z});
                const double rest_of_mean = std::max(most - values.mean, values.mean - values.least);
                const bool thin = sigma_t > 0.0 && across * rest_of_mean < 1.0;
                const double control = thin ? values.mean : values.least * (1.0 - rounding);
                const double rest = thin ? rest_of_mean : most - control;
                controls[i] = {float(control), float(rest + rounding * most)};
            }
    return controls;
}

} // namespace vkvol
