// vkvol init [GRID] -o SCENE.xml: a scene file to start from.
#pragma once

#include "options.h"

namespace vkvol {

// Throws InputError if there is such a file already, or the grid cannot be one of a scene.
int run_init(const InitOptions& options);

} // namespace vkvol
