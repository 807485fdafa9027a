// What to do about a density field that is not there.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace vkvol {

// The fields that tools/make_field knows.
inline constexpr std::array<std::string_view, 18> recipe_names = {
    "constant", "sphere",  "ramp", "checker", "voxel",   "spike",     "tiles",        "empty",       "sheared",
    "far",      "unclean", "glow", "head",    "cumulus", "explosion", "broken_cloud", "bunny_cloud", "fire"};

// The command that makes the file, if its name is that of a field which make_field knows; else where to look.
std::string missing_field_hint(const std::filesystem::path& file);

} // namespace vkvol
