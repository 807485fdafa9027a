// Maps of the sky that are nearly even, whose light flights alone find: looks toward them cost more than they bring.
#pragma once

#include "light_table.h"
#include "method.h"
#include "sky_map.h"

namespace vkvol {

// Whether it is so, for these media, and a method says nothing of how looks and flights share it. `sky`: or null.
bool is_left_to_flights(const Scene& scene, Media media, const Method& method, const SkyMap* sky);

// `method`, without looks where such a map is the only light.
Method without_idle_looks(const Scene& scene, Media media, const Method& method, const SkyMap* sky);

// No look goes toward the map; those toward other lights, of which there is at least one, are the more.
void leave_sky_to_flights(LightTable& table);

} // namespace vkvol
