#include "grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace reference {

namespace {

std::size_t offset(const glm::ivec3& i, const glm::ivec3& size) {
    return (static_cast<std::size_t>(i.z) * size.y + i.y) * size.x + i.x;
}

bool inside(const glm::ivec3& i, const glm::ivec3& size) {
    return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
}

} // namespace

void Grid::move(const glm::dmat4& transform) {
    linear = glm::dmat3(transform) * linear;
    translation = glm::dvec3(transform * glm::dvec4(translation, 1.0));
}

void ColorGrid::move(const glm::dmat4& transform) {
    for (Grid& channel : channels)
        channel.move(transform);
}

double Grid::voxel_length() const {
    return std::cbrt(std::abs(glm::determinant(linear)));
}

glm::dvec3 Grid::to_index(const glm::dvec3& world) const {
    return glm::inverse(linear) * (world - translation);
}

Ray Grid::to_index(const Ray& ray) const {
    const glm::dmat3 inverse = glm::inverse(linear);
    return {inverse * (ray.origin - translation), inverse * ray.direction};
}

Interval Grid::support(const Ray& index_ray) const {
    if (empty())
        return {};
    return intersect(glm::dvec3(lower), glm::dvec3(lower + size - 1), index_ray);
}

double Grid::voxel(const glm::ivec3& index) const {
    const glm::ivec3 i = index - lower;
    return inside(i, size) ? values[offset(i, size)] : 0.0;
}

double Grid::nearest(const glm::dvec3& index) const {
    return voxel(glm::ivec3(glm::floor(index + 0.5)));
}

double Grid::trilinear(const glm::dvec3& index) const {
    const glm::dvec3 base = glm::floor(index);
    const glm::dvec3 f = index - base;
    const glm::ivec3 i = glm::ivec3(base) - lower;
    if (!inside(i, size - 1))
        return 0.0;
    const float* v = &values[offset(i, size)];
    const std::size_t dy = size.x, dz = static_cast<std::size_t>(size.x) * size.y;
    const auto lerp = [](double a, double b, double t) { return a + t * (b - a); };
    const auto row = [&](std::size_t at) { return lerp(v[at], v[at + 1], f.x); };
    return lerp(lerp(row(0), row(dy), f.y), lerp(row(dz), row(dz + dy), f.y), f.z);
}

double Grid::looked_up(const glm::dvec3& index, bool nearest_voxel) const {
    return nearest_voxel ? nearest(index) : trilinear(index);
}

vkvol::Rgb ColorGrid::looked_up(const glm::dvec3& world, bool nearest_voxel) const {
    vkvol::Rgb color;
    for (int c = 0; c < 3; ++c)
        color[c] = channels[c].looked_up(channels[c].to_index(world), nearest_voxel);
    return color;
}

vkvol::Rgb ColorGrid::clamped(const glm::dvec3& world, bool nearest_voxel) const {
    const Grid& grid = channels[0]; // within its border of zeros
    const glm::dvec3 low(grid.lower + 1), high(grid.lower + grid.size - 2);
    const glm::dvec3 index = glm::clamp(grid.to_index(world), low, high);
    return looked_up(grid.linear * index + grid.translation, nearest_voxel);
}

Grid make_grid(const glm::ivec3& first, const glm::ivec3& last, const std::function<double(glm::ivec3)>& value,
               const glm::dmat3& linear, const glm::dvec3& translation) {
    Grid grid;
    grid.linear = linear;
    grid.translation = translation;
    if (first.x > last.x || first.y > last.y || first.z > last.z)
        return grid;
    grid.lower = first - 1;
    grid.size = last - first + 3;
    const double count = static_cast<double>(grid.size.x) * grid.size.y * grid.size.z;
    if (count > 0x1p31)
        throw std::runtime_error("the reference keeps grids as dense arrays: this one has too large a bounding box");
    grid.values.assign(static_cast<std::size_t>(count), 0.0f);
    for (int k = first.z; k <= last.z; ++k)
        for (int j = first.y; j <= last.y; ++j)
            for (int i = first.x; i <= last.x; ++i) {
                const float v = static_cast<float>(value({i, j, k}));
                if (std::isfinite(v) && v > 0.0f)
                    grid.values[offset(glm::ivec3(i, j, k) - grid.lower, grid.size)] = v;
            }
    build_majorants(grid, 8);
    return grid;
}

void build_majorants(Grid& grid, int cell) {
    if (grid.empty())
        return;
    const glm::ivec3 extent = grid.size - 1; // of the support, in index units
    grid.cell = cell == one_cell ? std::max({extent.x, extent.y, extent.z}) : cell;
    grid.cells = (extent + grid.cell - 1) / grid.cell;
    const std::size_t count = static_cast<std::size_t>(grid.cells.x) * grid.cells.y * grid.cells.z;
    grid.majorants.assign(count, 0.0f);
    grid.minorants.assign(count, std::numeric_limits<float>::infinity());
    for (int z = 0; z < grid.cells.z; ++z)
        for (int y = 0; y < grid.cells.y; ++y)
            for (int x = 0; x < grid.cells.x; ++x) {
                // Every voxel that takes part in an interpolation inside the cell, both faces included.
                const glm::ivec3 c(x, y, z), a = c * grid.cell, b = glm::min(a + grid.cell, extent);
                float& most = grid.majorants[offset(c, grid.cells)];
                float& least = grid.minorants[offset(c, grid.cells)];
                for (int k = a.z; k <= b.z; ++k)
                    for (int j = a.y; j <= b.y; ++j)
                        for (int i = a.x; i <= b.x; ++i) {
                            most = std::max(most, grid.values[offset({i, j, k}, grid.size)]);
                            least = std::min(least, grid.values[offset({i, j, k}, grid.size)]);
                        }
            }
}

MajorantWalk::MajorantWalk(const Grid& grid, const Ray& index_ray, const Interval& interval)
    : grid_(grid), ray_(index_ray), t_(interval.t0), end_(interval.t1), cell_(0) {
    if (interval.empty() || grid.empty()) {
        end_ = t_;
        return;
    }
    const glm::dvec3 entry = (index_ray.at(t_) - glm::dvec3(grid.lower)) / static_cast<double>(grid.cell);
    cell_ = glm::clamp(glm::ivec3(glm::floor(entry)), glm::ivec3(0), grid.cells - 1);
}

bool MajorantWalk::next(MajorantSegment& segment) {
    if (!(t_ < end_) || !inside(cell_, grid_.cells))
        return false;
    int axis = -1;
    double exit = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        if (ray_.direction[a] == 0.0)
            continue;
        const int face = cell_[a] + (ray_.direction[a] > 0.0 ? 1 : 0);
        const double t = (grid_.lower[a] + static_cast<double>(face) * grid_.cell - ray_.origin[a]) / ray_.direction[a];
        if (t < exit) {
            exit = t;
            axis = a;
        }
    }
    const std::size_t i = offset(cell_, grid_.cells);
    segment = {t_, std::clamp(exit, t_, end_), grid_.majorants[i], grid_.minorants[i]};
    t_ = segment.t1;
    cell_[axis] += ray_.direction[axis] > 0.0 ? 1 : -1;
    return true;
}

} // namespace reference
