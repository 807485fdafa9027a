// Next-event estimation toward the directional light. Its contribution at a collision is
// beta * p(direction, towards the light) * irradiance * T, with the collision's albedo already in beta.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL
#include "phase.glsl"

vec3 sun_contribution(VolumeParams v, LightParams light, vec3 direction, float beta) {
    // |a - b|^2 / 2 is 1 - a.b for unit vectors, with all digits where they nearly agree.
    vec3 apart = direction - light.direction;
    return beta * hg_eval(v.g, 0.5 * dot(apart, apart)) * light.irradiance;
}

#endif
