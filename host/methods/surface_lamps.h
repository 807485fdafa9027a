// Surfaces that shine, as lights: looked for, where else paths would have to meet them by chance.
#pragma once

#include "scene.h"

namespace vkvol {

// Where they are few, balls, disks and rectangles that shine no longer do: in their place are lamps whose bodies they
// are. All others but planes go on to shine, and are lights, too. A scene that has such lights is what it was.
Scene with_lamps_of_surfaces(Scene scene);
bool has_lamps_of_surfaces(const Scene& scene); // whether there would be any such light
// As it was before.
Scene without_lamps_of_surfaces(Scene scene);

} // namespace vkvol
