// Whether a frame's pictures are there already, so that a sequence that is gone on with passes over it.
#pragma once

#include "options.h"

namespace vkvol {

// All outputs are there, none older than the scene's grids, and no checkpoint to go on from. Each .exr says that it is
// whole and of this scene, integrator, seed, window and samples; files of other kinds say nothing, and are believed.
bool rendered_before(const RenderOptions& options, const Scene& scene);

} // namespace vkvol
