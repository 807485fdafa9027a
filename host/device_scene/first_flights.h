// Whether a scene's first flights had better be split: see shaders/estimators/split.glsl.
#pragma once

#include "loaded_medium.h"
#include "scene.h"

namespace vkvol {

// Where the medium is thin, and nothing bright is behind it: most flights that are drawn go through then, and see
// nothing.
bool gains_by_split_flights(const Scene& scene, Media media);

} // namespace vkvol
