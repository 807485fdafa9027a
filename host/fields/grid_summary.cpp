#include "grid_summary.h"

#include <algorithm>
#include <array>

namespace vkvol {

namespace {

void add_value(GridSummary& s, double value, std::uint64_t voxels) {
    s.low = s.positive == 0 ? value : std::min(s.low, value);
    s.high = std::max(s.high, value);
    s.sum += value * static_cast<double>(voxels);
    s.positive += voxels;
}

// Sums along the 8 x 8 lines through one column of blocks, along `axis`.
struct Lines {
    std::array<double, 64> sums{};
    double everywhere = 0.0; // to be added to each

    void add(const DensityField::Block& part, const DensityField& field, int axis, GridSummary* s) {
        if (part.constant)
            return add_constant(part, *part.constant, axis, s);
        for (int x = part.low.x; x <= part.high.x; ++x)
            for (int y = part.low.y; y <= part.high.y; ++y)
                for (int z = part.low.z; z <= part.high.z; ++z)
                    if (const double value = field.value({x, y, z}); value > 0.0) {
                        line({x, y, z}, axis) += value;
                        if (s)
                            add_value(*s, value, 1);
                    }
    }

private:
    double& line(glm::ivec3 voxel, int axis) {
        return sums[std::size_t((voxel[(axis + 1) % 3] & 7) * 8 + (voxel[(axis + 2) % 3] & 7))];
    }

    void add_constant(const DensityField::Block& part, double value, int axis, GridSummary* s) {
        if (value <= 0.0)
            return;
        const glm::ivec3 size = part.high - part.low + 1;
        if (s)
            add_value(*s, value, std::uint64_t(size.x) * std::uint64_t(size.y) * std::uint64_t(size.z));
        if (size == glm::ivec3(8)) {
            everywhere += 8.0 * value;
            return;
        }
        glm::ivec3 last = part.high; // one voxel of each line
        last[axis] = part.low[axis];
        for (int x = part.low.x; x <= last.x; ++x)
            for (int y = part.low.y; y <= last.y; ++y)
                for (int z = part.low.z; z <= last.z; ++z)
                    line({x, y, z}, axis) += size[axis] * value;
    }
};

// Column by column of blocks, since a box of stray voxels can have more lines than fit in memory.
void add_columns(const DensityField& field, int axis, GridSummary& s) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::uint64_t filled = 0;
    double sum = 0.0;
    glm::ivec3 block;
    for (block[u] = 0; block[u] < field.leaf_dims[u]; ++block[u])
        for (block[v] = 0; block[v] < field.leaf_dims[v]; ++block[v]) {
            Lines lines;
            for (block[axis] = 0; block[axis] < field.leaf_dims[axis]; ++block[axis])
                lines.add(field.block(block), field, axis, axis == 0 ? &s : nullptr);
            for (const double part : lines.sums) {
                const double line = part + lines.everywhere;
                s.largest_column[axis] = std::max(s.largest_column[axis], line);
                sum += line;
                filled += line > 0.0;
            }
        }
    s.mean_column[axis] = filled > 0 ? sum / static_cast<double>(filled) : 0.0;
}

} // namespace

GridSummary summarize(const DensityField& field) {
    GridSummary s;
    for (int axis = 0; axis < 3; ++axis)
        add_columns(field, axis, s);
    return s;
}

std::pair<glm::dvec3, glm::dvec3> world_box(const DensityField& field) {
    glm::dvec3 low(1e300), high(-1e300);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 index =
            glm::mix(glm::dvec3(field.voxel_min) - 0.5, glm::dvec3(field.voxel_max) + 0.5, glm::dvec3(pick));
        const glm::dvec3 world(field.index_to_world * glm::dvec4(index, 1.0));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    return {low, high};
}

glm::dvec3 voxel_edges(const DensityField& field) {
    const glm::dmat3 linear(field.index_to_world);
    return {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
}

} // namespace vkvol
