// Where a medium is: a space of its own, and that space's place in the world.
#pragma once

#include "loaded_medium.h"

namespace vkvol {

// Where the device counts a grid's voxels from. Some tools give grids far from the world's origin indices in the
// millions, at which single precision knows a sixteenth of a voxel; below 4096 it knows half a thousandth, and grids
// that reach as far as they are away would gain nothing. A multiple of 8, so that leaves stay leaves.
glm::ivec3 index_base(const DensityField& field);

// Index space counted from there -> world.
glm::dmat4 index_to_world(const DensityField& field);

// Medium space -> world: a ball, a cube, the grid's own index space, a mesh about its middle, or cells across layers.
glm::dmat4 medium_to_world(const Volume& volume, const LoadedMedium& loaded);
glm::dmat4 world_to_medium(const Volume& volume, const LoadedMedium& loaded);

// Where the shape of a ball, a cube or a mesh has its middle, and half of its edges, before its volume's transform.
struct UnmovedShape {
    glm::dvec3 center{0.0}, half{1.0};
};
UnmovedShape unmoved_shape(const Volume& volume, const LoadedMedium& loaded);

// Medium space, where the density can differ from 0: of a grid one voxel around the active ones, for interpolation.
struct MediumBounds {
    glm::dvec3 low{-1.0}, high{1.0};
};
MediumBounds medium_bounds(const LoadedMedium& loaded);

// Diagonal of the medium's box, in world units.
double diagonal_of(const Volume& volume, const LoadedMedium& loaded);
// World units, from the box around the medium; 0 within.
double distance_to(const Volume& volume, const LoadedMedium& loaded, const glm::dvec3& position);
glm::dvec3 middle_of(const Volume& volume, const LoadedMedium& loaded);

} // namespace vkvol
