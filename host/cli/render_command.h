// The render command: scene in, images out.
#pragma once

#include "options.h"

namespace vkvol {

class Workshop;

// Returns the exit code; throws InputError, DeviceError or RenderError.
int run_render(const RenderOptions& options);

// The same of one picture, or one frame of a sequence.
int render_picture(const RenderOptions& options, Workshop& workshop);

// What can be told without a device: the command line, the scene, and whether the outputs can be written. Throws
// InputError.
void check_picture(const RenderOptions& options, Workshop& workshop);

} // namespace vkvol
