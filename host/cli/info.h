// vkvol info FILE: what a density file holds, and a view of it to start from.
#pragma once

#include <filesystem>

namespace vkvol {

int run_info(const std::filesystem::path& file, bool json = false);

} // namespace vkvol
