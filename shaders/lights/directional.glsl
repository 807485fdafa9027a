// Next-event estimation toward the directional light. Its contribution at a collision is
// beta * p(direction, towards the light) * irradiance * T, with the collision's albedo already in beta.
#ifndef DIRECTIONAL_GLSL
#define DIRECTIONAL_GLSL
#include "phase/phase.glsl"
#include "lib/spectrum.glsl"

vec3 directional_contribution(MediumParams v, LightParams light, vec3 direction, Spectrum beta) {
    return beta * phase_eval(v, direction, light.direction) * light.radiance;
}

#endif
