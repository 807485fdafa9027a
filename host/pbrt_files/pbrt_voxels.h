// Grids of values that stand in a pbrt scene: their bounds and numbers of voxels.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "pbrt_scene.h"

namespace vkvol {

struct PbrtBounds {
    glm::dvec3 low, size;
};

// p0 and p1. Throws InputError where they enclose nothing.
PbrtBounds bounds_of(const PbrtThing& medium);

// nx, ny, nz. Throws InputError where they are not from 1 to 4096.
glm::ivec3 dims_of(const PbrtThing& medium);
std::size_t voxel_count(glm::ivec3 dims);

// From places of voxels, whose values are at their middles, to the medium's space.
glm::dmat4 voxels_to_medium(const PbrtBounds& bounds, glm::ivec3 dims);

// Whether it is seen that grids fall to 0 beyond their bounds, where pbrt's end at them.
bool has_soft_edge(glm::ivec3 dims, const std::vector<float>& values);
inline constexpr const char* soft_edge_note = "the densities at the grid's edge fall to 0 within half a voxel beyond "
                                              "its bounds, and not at them; outermost voxels "
                                              "of 0 change nothing and are left as they are";

} // namespace vkvol
