// What <absorption> reads, as a grid.
#pragma once

#include <filesystem>
#include <string>

#include "film.h"
#include "scene.h"

namespace vkvol {

bool is_reading_grid(const std::filesystem::path& target); // by its ending

// Throws InputError unless the sensor has cells.
void check_grid_file(const std::filesystem::path& target, const Camera& camera);

// As the bytes of an .nvdb file: a grid "absorbed" of numbers, or of colours where the channels differ, each cell a
// voxel where it stands in the world; 0 beyond the crop.
std::string reading_grid(const Film& film, const Camera& camera);

} // namespace vkvol
