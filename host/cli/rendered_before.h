// Whether a frame's pictures are there already, so that a sequence that is gone on with passes over it.
#pragma once

#include <optional>

#include "options.h"

namespace vkvol {

// The exit code that rendering it had, or none: it is to be rendered. All files are there, none older than what the
// scene is made of, and no checkpoint to go on from; one is an .exr, which says that it is whole and what was asked
// for.
std::optional<int> rendered_before(const RenderOptions& options, const Scene& scene);

} // namespace vkvol
