// What the renderer does with a scene before anything runs on a device, and what it relies on.
#pragma once

#include "scene.h"

namespace vkvol {
struct DensityField;
}

namespace vkvol::fuzz {

// Opens the scene's files and fills what the kernels see. Throws InputError, or Finding for what is not finite.
void use_scene(const Scene& scene);

// The kernels look up without bounds checks: every entry of the leaf table must lie within the grid's bytes, and every
// value must be one that a density can have.
void check_field(const DensityField& field);

} // namespace vkvol::fuzz
