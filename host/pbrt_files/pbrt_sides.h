// Which sides of a shape its media are on: pbrt's normals decide.
#pragma once

#include "pbrt_scene.h"

namespace vkvol {

// A closed shape whose normals point into it: by ReverseOrientation, by the order of its points, or, of quadrics, by a
// mirror, which turns those of pbrt about. What a mesh in a file has is taken to point outwards. Throws InputError as
// read_triangles does.
bool faces_inwards(const PbrtShape& shape);

// By an "alpha" of 0: rays go on as if it were not there.
bool is_never_met(const PbrtShape& shape);

// Names of media, empty: vacuum, or nothing that anything meets.
struct PbrtSides {
    std::string within, beyond;
};
PbrtSides sides_of(const PbrtShape& shape);

} // namespace vkvol
