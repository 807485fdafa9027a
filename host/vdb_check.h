// The structure of .vdb files, walked before OpenVDB reads them: OpenVDB takes every count and size in a file for true.
#pragma once

#include <filesystem>

namespace vkvol {

// Throws InputError where a count, a size or an offset of the file's headers, or of the named grid of floats (if `grid`
// is not null and the file has it), leads beyond the file or contradicts another.
void check_vdb(const std::filesystem::path& file, const char* grid);

} // namespace vkvol
