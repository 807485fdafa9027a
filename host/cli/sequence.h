// Several frames of one scene in one process.
#pragma once

#include "options.h"

namespace vkvol {

// All of them are checked before the first is rendered. Ends with the first that fails, or that is interrupted. Returns
// the exit code; throws as run_render does, with the frame's number in the message.
int run_sequence(const RenderOptions& options);

} // namespace vkvol
