// What a density grid holds, in numbers for people.
#pragma once

#include <utility>

#include "density_field.h"

namespace vkvol {

// Values of active voxels are told from background by being above 0, which is all a density can say.
struct GridSummary {
    double low = 0.0, high = 0.0, sum = 0.0;
    std::uint64_t positive = 0;
    // Sums of values along the lines of voxels parallel to each axis: largest, and mean over lines that are not empty.
    glm::dvec3 largest_column{0.0}, mean_column{0.0};

    double mean() const { return positive > 0 ? sum / static_cast<double>(positive) : 0.0; }
};

GridSummary summarize(const DensityField& field);

// The box around all voxels, whose middles are at whole indices; world space.
std::pair<glm::dvec3, glm::dvec3> world_box(const DensityField& field);

// Edges of a voxel along the three axes of the grid, in world units.
glm::dvec3 voxel_edges(const DensityField& field);

} // namespace vkvol
