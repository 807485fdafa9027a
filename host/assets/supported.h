// What can be read but not rendered by this version: decided here, and nowhere else.
#pragma once

#include "scene.h"

namespace vkvol {

// Throws InputError, in one line, for a scene of more media, maps of the sky, lamps or suns than the kernels have room
// or time for.
void check_supported(const Scene& scene);

} // namespace vkvol
