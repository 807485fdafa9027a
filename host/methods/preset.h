// What an integrator makes of a scene before it is rendered.
#pragma once

#include "integrators.h"

namespace vkvol {

// The scene as its integrator sees it, with warnings added. Applying it twice changes nothing more. Of
// adjust_material_colour nothing is done here, since a mesh's colour is known only once it is loaded.
Scene with_preset(Scene scene);

// Where something moves and no integrator is named: with the one that renders all moments, also those without light.
Scene with_steady_integrator(Scene scene);

// SCATTERING_...: single scattering is one event, of which maxDepth allows none.
int scattering_of(const RenderSettings& settings, const Integrator& integrator);

} // namespace vkvol
