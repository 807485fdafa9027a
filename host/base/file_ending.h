// What a file is, by the ending of its name: .vdb, .VDB and .Vdb are the same.
#pragma once

#include <filesystem>
#include <string>

namespace vkvol {

// The name's last dot and what follows it, in lower case; empty without a dot.
std::string file_ending(const std::filesystem::path& file);

// A file that holds grids: .nvdb or .vdb.
bool is_grid_file(const std::filesystem::path& file);

} // namespace vkvol
