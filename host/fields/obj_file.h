// Wavefront .obj files.
#pragma once

#include "polygons.h"

namespace vkvol {

// InputError as read_polygons.
Polygons read_obj(const std::filesystem::path& path);

// The material libraries that it names, whether or not they are there. None if it cannot be read.
std::vector<std::filesystem::path> material_libraries(const std::filesystem::path& path);

} // namespace vkvol
