// What lies in a surface, as nearly as rays know it, is kept off it.
#pragma once

#include <vector>

#include "light_table.h"
#include "scene.h"
#include "surface_table.h"

namespace vkvol {

// How far from its middle a light with a place reaches, at most. World units.
double extent_of(const shared::LightRow& light);

// Lights in the plane of what is far larger than they are far from the origin: by how much particles begin off it.
void keep_apart(std::vector<shared::LightRow>& lights, const SurfaceTable& surfaces);

// A sensor of irradiance that lies in a surface, or touches a ball, lies before it, by more than places there err: so
// particles that come to the surface pass it, and those that leave it do not (count.glsl). World units; 0 of one that
// lies in none. `origin`: of render space.
double shift_of_sensor(const Scene& scene, const SurfaceTable& surfaces, const glm::dvec3& origin);

} // namespace vkvol
