// Whether a scene's first flights had better be split: see shaders/estimators/split.glsl.
#pragma once

#include "loaded_medium.h"
#include "scene.h"

namespace vkvol {

// Where the medium is thin, and nothing bright is behind it: most flights that are drawn go through then, and see
// nothing.
bool gains_by_split_flights(const Scene& scene, Media media);

// Chance, roughly, that a ray which meets a grid's matter collides with it, mean over rays along the grid's axes; of
// other media over such as cross them. In [0, 1].
double chance_to_collide(const Volume& volume, const LoadedMedium& loaded);

} // namespace vkvol
