// A fingerprint of what a scene's expected picture depends on: merge refuses images that differ in it.
#pragma once

#include <string>

#include "scene.h"

namespace vkvol {

// 16 hexadecimal digits over camera, picture, media, lights and the settings that change the expectation (maxDepth,
// filter, a majorant scale below 1). Grids count by file name and size, not by folder, so that two machines agree.
// Samples per pixel, integrator and warnings do not count.
std::string scene_hash(const Scene& scene);

} // namespace vkvol
