// The `info` command: what is in a grid file.
#pragma once

#include <filesystem>

namespace vkvol {

// Grids, types, boxes, voxel size, active voxels, value range, memory, and optical depth across the box per unit sigma,
// on standard output. Returns the exit code; throws InputError for a file that cannot be read.
int run_info(const std::filesystem::path& file);

} // namespace vkvol
