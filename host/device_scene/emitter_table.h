// What sends out particles, as kernels choose among it: see shaders/lights/emit.glsl.
#pragma once

#include <vector>

#include "light_table.h"
#include "method.h"
#include "surface_table.h"

namespace vkvol {

struct EmitterTable {
    std::vector<shared::EmitterRow> rows; // at least one
    shared::ParticleParams params{};
};

// What a scene sends out, in render space. Each kind of source is chosen in proportion to its power, roughly, and never
// with less than a tenth of an even chance. `media`: of several; else of the frame's one, `medium`. `radius`: of a ball
// about the origin that holds all there is, and a sensor that counts particles; not finite where nothing does. `origin`
// of render space.
EmitterTable make_emitter_table(const Scene& scene, const Method& method, const LightTable& lights,
                                const SurfaceTable& surfaces, const shared::MediumParams& medium,
                                std::span<const shared::MediumParams> media, const shared::PeriodParams& period,
                                double radius, glm::dvec3 origin);

} // namespace vkvol
