// A fingerprint of what a scene's expected picture depends on: merge refuses images that differ in it.
#pragma once

#include <string>

#include "scene.h"

namespace vkvol {

// 16 hexadecimal digits over camera, picture, media, the lights that are seen and the settings that change the
// expectation: the kind of scattering, maxDepth, a nearest filter; of biased estimators, what their bias depends on.
// Which unbiased estimators are used does not count, nor samples per pixel and warnings. Files count by name, size and
// content, not by folder, so that two machines agree: of more than 64 MiB the content of parts, see digest_of_file.
// Throws InputError for a scene that cannot be rendered.
std::string scene_hash(const Scene& scene);

} // namespace vkvol
