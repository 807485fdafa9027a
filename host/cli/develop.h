// Looking at an image again: from linear radiance to an 8-bit picture, without rendering.
#pragma once

#include "options.h"

namespace vkvol {

// The `develop` command.
int run_develop(const DevelopOptions& options);

} // namespace vkvol
