// The header of an EXR file, walked before OpenEXR reads it: OpenEXR gives memory for what a header states.
#pragma once

#include <filesystem>

namespace vkvol {

// Throws InputError where an attribute leads beyond the file, or the windows and tiles promise more than it can hold.
void check_exr_header(const std::filesystem::path& file);

} // namespace vkvol
