// The camera, or what reads flux, as kernels have it: see shaders/sensors.
#pragma once

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

// `origin`: of render space, the middle of the media. `radius`: of a ball about it that holds media and lamps.
shared::SensorParams sensor_params(const Scene& scene, const glm::dvec3& origin, double radius);

} // namespace vkvol
