// What of the light a method cannot find, or finds by chance alone.
#pragma once

#include "method.h"

namespace vkvol {

// Sets `biases`, `biased` and `by_chance`, and adds warnings. `field`: FIELD_..., as the method was chosen for.
void find_biases(const Scene& scene, int field, Method& method);

} // namespace vkvol
