// The camera, or what reads flux, as kernels have it: see shaders/sensors.
#pragma once

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

// `origin`: of render space, the middle of the media. `radius`: of a ball about it that holds media and lamps.
// A sensor in a surface's plane lies before it, by more than places on surfaces err: so particles that come to the
// surface pass it, and those that leave it do not (count.glsl). World units.
double shift_of_sensor(const Scene& scene, const glm::dvec3& origin);

shared::SensorParams sensor_params(const Scene& scene, const glm::dvec3& origin, double radius);

} // namespace vkvol
