// The render command: scene in, images out.
#pragma once

#include "options.h"

namespace vkvol {

// Returns the exit code; throws InputError, DeviceError or RenderError.
int run_render(const RenderOptions& options);

} // namespace vkvol
