// Phase functions: one file each, one switch. `before` and `after`: directions of propagation, unit.
#ifndef PHASE_GLSL
#define PHASE_GLSL
#include "lib/buffers.glsl"
#include "phase/henyey_greenstein.glsl"
#include "phase/rayleigh.glsl"

// Per steradian; integrates to 1 over `after`.
float phase_eval(MediumParams v, vec3 before, vec3 after) {
    switch (PHASE) {
    case PHASE_RAYLEIGH:
        return rayleigh_eval(dot(before, after));
    default:
        return hg_eval(v.g, hg_from_peak(v.g, before, after));
    }
}

// After two scatterings: the mean of phase_eval(drawn, after) over what phase_sample draws from `before`. Henyey and
// Greenstein's functions are closed under convolution, asymmetries multiply.
float phase_eval_twice(MediumParams v, vec3 before, vec3 after) {
    switch (PHASE) {
    case PHASE_RAYLEIGH:
        return rayleigh_eval_twice(dot(before, after));
    default:
        return hg_eval(v.g * v.g, hg_from_peak(v.g * v.g, before, after));
    }
}

// A direction distributed as phase_eval; u in [0, 1)^2.
vec3 phase_sample(MediumParams v, vec3 before, vec2 u) {
    switch (PHASE) {
    case PHASE_RAYLEIGH:
        return turned(before, 1.0 - rayleigh_sample_cosine(u.x), u.y);
    default:
        return hg_sample(v.g, before, u);
    }
}

#endif
