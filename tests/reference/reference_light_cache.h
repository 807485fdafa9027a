// Direct light from transmittances that are known roughly beforehand; the specification is
// shaders/lights/light_cache.glsl.
#pragma once

#include "path.h"

namespace reference {

// A rough transmittance towards the light, the same whenever it is asked for; exactness is not its business.
vkvol::Rgb rough_transmittance(const Medium& medium, const Ray& ray);

// As direct_light, for a path of throughput beta: some of the light by chance, the expectation the same.
vkvol::Rgb cached_light(const World& world, const glm::dvec3& p, const glm::dvec3& travel, const vkvol::Rgb& beta,
                        Rng& rng);

// What was foreseen of the light at p, of expectation 0: to be subtracted when a path that travelled along `before`
// departs from p along `after`, times its throughput.
vkvol::Rgb foreseen_light(const World& world, const glm::dvec3& p, const glm::dvec3& before, const glm::dvec3& after);

} // namespace reference
