// The render command: scene in, images out.
#pragma once

#include <vector>

#include "file_uses.h"
#include "options.h"
#include "scene.h"

namespace vkvol {

class Workshop;

// Returns the exit code; throws InputError, DeviceError or RenderError.
int run_render(const RenderOptions& options);

// The same of one picture, or one frame of a sequence.
int render_picture(const RenderOptions& options, Workshop& workshop);

struct CheckedPicture {
    std::vector<GridFile> grids; // that the scene may have
    FileUses uses;
};

// What can be told without a device: the command line, the scene, and whether the outputs can be written. Throws
// InputError.
CheckedPicture check_picture(const RenderOptions& options, Workshop& workshop);

} // namespace vkvol
