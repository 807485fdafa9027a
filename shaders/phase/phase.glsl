// Phase functions: one file each, one switch. `before` and `after`: directions of propagation, unit.
#ifndef PHASE_GLSL
#define PHASE_GLSL
#include "lib/buffers.glsl"
#include "phase/double_henyey_greenstein.glsl"
#include "phase/draine.glsl"
#include "phase/droplets.glsl"
#include "phase/henyey_greenstein.glsl"
#include "phase/phase_table.glsl"
#include "phase/rayleigh.glsl"

// Per steradian; integrates to 1 over `after`.
float phase_eval(MediumParams v, vec3 before, vec3 after) {
    switch (PHASE) {
    case PHASE_RAYLEIGH:
        return rayleigh_eval(dot(before, after));
    case PHASE_DOUBLE_HENYEY_GREENSTEIN:
        return double_hg_eval(v.phase, before, after);
    case PHASE_DRAINE:
        return draine_eval(v.phase.g, v.phase.alpha, hg_from_peak(v.phase.g, before, after));
    case PHASE_DROPLETS:
        return droplets_eval(v.phase, before, after);
    case PHASE_TABLE:
        return table_eval(v.phase, before, after);
    default:
        return hg_eval(v.phase.g, hg_from_peak(v.phase.g, before, after));
    }
}

// Whether there is a closed form of two scatterings.
const bool PHASE_HAS_TWICE = PHASE <= PHASE_DOUBLE_HENYEY_GREENSTEIN;

// After two scatterings: the mean of phase_eval(drawn, after) over what phase_sample draws from `before`. Henyey and
// Greenstein's functions are closed under convolution, asymmetries multiply.
float phase_eval_twice(MediumParams v, vec3 before, vec3 after) {
    switch (PHASE) {
    case PHASE_RAYLEIGH:
        return rayleigh_eval_twice(dot(before, after));
    case PHASE_DOUBLE_HENYEY_GREENSTEIN:
        return double_hg_eval_twice(v.phase, before, after);
    default:
        return hg_eval(v.phase.g * v.phase.g, hg_from_peak(v.phase.g * v.phase.g, before, after));
    }
}

// A direction distributed as phase_eval; u in [0, 1)^2.
vec3 phase_sample(MediumParams v, vec3 before, vec2 u) {
    switch (PHASE) {
    case PHASE_RAYLEIGH:
        return turned(before, 1.0 - rayleigh_sample_cosine(u.x), u.y);
    case PHASE_DOUBLE_HENYEY_GREENSTEIN:
        return double_hg_sample(v.phase, before, u);
    case PHASE_DRAINE:
        return draine_sample(v.phase.g, v.phase.alpha, before, u);
    case PHASE_DROPLETS:
        return droplets_sample(v.phase, before, u);
    case PHASE_TABLE:
        return table_sample(v.phase, before, u);
    default:
        return hg_sample(v.phase.g, before, u);
    }
}

#endif
