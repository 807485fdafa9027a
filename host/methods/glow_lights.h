// Media that glow, as lights: looked for, where else flights would have to meet them by chance.
#pragma once

#include "scene.h"

namespace vkvol {

// Balls and boxes of even density that glow evenly, where there is something else that they may light: surfaces, or
// other media. (What a sensor of flux sees of a lone one flights find without noise, from within it.) They go on to
// glow, and flights to meet them. A scene that has such lights is what it was.
Scene with_lights_of_glow(Scene scene);
bool has_lights_of_glow(const Scene& scene); // whether there would be any such light
// As it was before.
Scene without_lights_of_glow(Scene scene);

} // namespace vkvol
