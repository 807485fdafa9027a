// The render command: scene in, images out.
#pragma once

#include <vector>

#include "options.h"
#include "scene.h"

namespace vkvol {

class Workshop;

// Returns the exit code; throws InputError, DeviceError or RenderError.
int run_render(const RenderOptions& options);

// The same of one picture, or one frame of a sequence.
int render_picture(const RenderOptions& options, Workshop& workshop);

// What can be told without a device: the command line, the scene, and whether the outputs can be written. Returns the
// grids that the scene may have. Throws InputError.
std::vector<GridFile> check_picture(const RenderOptions& options, Workshop& workshop);

} // namespace vkvol
