// OpenVDB files. Kept apart because OpenVDB's headers take half a minute to compile.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nvdb_file.h"
#include "vdb_check.h"

namespace vkvol {

// Both throw InputError naming the file, what is wrong, and the remedy.
std::vector<VdbEntry> read_vdb_entries(const std::filesystem::path& file);
// A grid of floats or, if allowed, of colours (stored as float or half) as NanoVDB; its class and transform are kept.
GridBytes read_vdb_grid(const std::filesystem::path& file, const std::string& name, GridValues allowed);

} // namespace vkvol
