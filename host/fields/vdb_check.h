// The structure of .vdb files, walked before OpenVDB reads them: OpenVDB takes every count and size in a file for true.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grid_values.h"

namespace vkvol {

// Name and type ("Tree_float_5_4_3") of a grid. Of several grids of one name, all but the first are "name[1]", ...
struct VdbEntry {
    std::string name;
    std::string type;
};

// The grids of a file, in its order. Throws InputError where a count, a size or an offset of the file's headers, or of
// the grid of this number, if one is given, leads beyond the file or contradicts another, or where that grid's values
// are not `allowed`. What is wrong with other grids is no reason to refuse this one.
std::vector<VdbEntry> check_vdb(const std::filesystem::path& file, std::optional<std::size_t> number,
                                GridValues allowed);

} // namespace vkvol
