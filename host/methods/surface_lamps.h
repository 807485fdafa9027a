// Surfaces that shine, as lamps: looked for, where else paths would have to meet them by chance.
#pragma once

#include "scene.h"

namespace vkvol {

// Balls, disks and rectangles that shine no longer do; in their place are lights whose bodies they are. Meshes, boxes
// and planes go on to shine, and so do all if there are so many that seeing them as lamps would take too long.
Scene with_lamps_of_surfaces(Scene scene);
bool has_lamps_of_surfaces(const Scene& scene); // whether any would
// As it was before.
Scene without_lamps_of_surfaces(Scene scene);

} // namespace vkvol
