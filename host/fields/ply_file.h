// Stanford .ply files (Turk, "The PLY Polygon File Format", 1994): text, or binary of either byte order.
#pragma once

#include "polygons.h"

namespace vkvol {

// Elements and properties other than a vertex' x, y, z, nx, ny, nz and a face's list of vertices are passed over.
// InputError as read_polygons.
Polygons read_ply(const std::filesystem::path& path);

// Whether its vertices have places on a texture. InputError as above, as far as the header tells.
bool has_ply_places(const std::filesystem::path& path);

} // namespace vkvol
