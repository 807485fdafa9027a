// The scene of `vkvol demo`, which lies where the program is installed, or in its sources.
#pragma once

#include <filesystem>

namespace vkvol {

// Throws InputError where there is none, or its density field was not made.
std::filesystem::path demo_scene();

} // namespace vkvol
