// What <absorption> reads, as a grid.
#pragma once

#include <filesystem>
#include <string>

#include "film.h"
#include "scene.h"

namespace vkvol {

// Throws InputError unless the sensor has cells, of which none is left out.
void check_grid_file(const std::filesystem::path& target, const Camera& camera, bool is_cropped);

// As the bytes of an .nvdb or .vdb file, as `target` ends: a grid "absorbed" of numbers, or of colours where the
// channels differ, each cell a voxel where it stands in the world; and, of two samples and more, "absorbed_error", the
// standard errors.
std::string reading_grid(const Film& film, const Camera& camera, const std::filesystem::path& target);

} // namespace vkvol
