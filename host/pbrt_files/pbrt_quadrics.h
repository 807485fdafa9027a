// pbrt's spheres, disks and cylinders as triangles, where a scene here has no such shape: parts of them, what is
// stretched, and what has its front inside.
#pragma once

#include "pbrt_triangles.h"

namespace vkvol {

// Whether it is whole and stays what it is under `map`, up to its size.
bool is_whole_ball_or_disk(const PbrtThing& shape, const glm::dmat4& map);

// Triangles of a "sphere", "disk" or "cylinder", in the shape's own space: of 1/128 of a turn, off by a part of 3e-4 of
// the radius. Their front is where pbrt's normal is, their places on textures are pbrt's. Throws InputError for
// radii, heights and angles that make no shape.
PbrtTriangles quadric_triangles(const PbrtThing& shape);

} // namespace vkvol
