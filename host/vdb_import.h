// OpenVDB files. Kept apart because OpenVDB's headers take half a minute to compile.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nvdb_file.h"

namespace vkvol {

// Name and type ("Tree_float_5_4_3") of each grid in a .vdb file.
struct VdbEntry {
    std::string name;
    std::string type;
};

// Both throw InputError naming the file, what is wrong, and the remedy.
std::vector<VdbEntry> read_vdb_entries(const std::filesystem::path& file);
// A float grid (stored as float or half) as NanoVDB; its class and transform are kept.
GridBytes read_vdb_grid(const std::filesystem::path& file, const std::string& name);

} // namespace vkvol
