// What sends out particles, as kernels choose among it: see shaders/lights/particle.glsl.
#pragma once

#include <vector>

#include "light_table.h"
#include "method.h"
#include "sky_map.h"
#include "surface_table.h"

namespace vkvol {

struct EmitterTable {
    std::vector<shared::EmitterRow> rows; // behind the pieces of LightTable, at least one
    shared::ParticleParams params{};
};

// All media that glow: their power, roughly, the most radiance per unit of extinction, and a box about them in
// render space.
struct Glow {
    double power = 0.0, most = 0.0;
    double hidden = 0.0; // of the power what a black body's face would not let out
    glm::dvec3 corner{0.0};
    glm::dmat3 edges{0.0};
};
// `rows`: as many as the scene has volumes.
Glow glow_of(const Scene& scene, Media loaded, std::span<const shared::MediumParams> rows);

// What a scene sends out, in render space. Each kind of source is chosen in proportion to its power, roughly, and never
// with less than a tenth of an even chance. `radius`: of a ball about the origin that holds all there is, and a sensor
// that counts particles; not finite where nothing does. `sky`: its map, if any. `origin` of render space; `pixels`
// of the window.
EmitterTable make_emitter_table(const Scene& scene, Media loaded, const Method& method, const LightTable& lights,
                                const SurfaceTable& surfaces, const Glow& glow, const SkyMap* sky,
                                const shared::PeriodParams& period, double radius, glm::dvec3 origin, double pixels);

} // namespace vkvol
