// Which estimators a path is made of.
#pragma once

#include <string>

#include "medium.h"

namespace reference {

// Ids of shaders/shared/constants.h. `march` is resolved.
struct Method {
    std::string name; // of the preset
    int scattering = 0, free_flight = 0, transmittance = 0, nee = 0, emission = 0;
    vkvol::March march;
};

// The scene's integrator and choices, and the medium they are for: presets may set what they need of the volume. With
// no name, delta tracking, and next-event estimation by ratio tracking if there is a light. Throws std::runtime_error
// for unknown names and for choices that do not go together.
Method resolve_method(const vkvol::Scene& scene, Medium& medium);

// What presets change in the volume before it is opened.
vkvol::Volume preset_volume(const std::string& integrator, vkvol::Volume volume);

} // namespace reference
