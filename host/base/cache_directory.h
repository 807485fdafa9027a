// Where programs keep for this user what they could make again: ${XDG_CACHE_HOME:-~/.cache}.
#pragma once

#include <filesystem>

namespace vkvol {

// The folder in which all programs have theirs; empty if there is none.
std::filesystem::path cache_home();

// Our own in it, which need not exist yet; empty if there is none.
std::filesystem::path cache_directory();

} // namespace vkvol
