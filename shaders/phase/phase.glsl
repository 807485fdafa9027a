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

// (One `return` each: a `switch` of them would leave a loop behind, see tools/results/README.md.)

// Per steradian; integrates to 1 over `after`.
float phase_eval(MediumParams v, vec3 before, vec3 after) {
    float p = 0.0;
    const int kind = KIND(PHASE, v, phase);
    if (kind == PHASE_HENYEY_GREENSTEIN)
        p = hg_eval(v.phase.g, hg_from_peak(v.phase.g, before, after));
    else if (kind == PHASE_RAYLEIGH)
        p = rayleigh_eval(v.phase.share, dot(before, after));
    else if (kind == PHASE_DOUBLE_HENYEY_GREENSTEIN)
        p = double_hg_eval(v.phase, before, after);
    else if (kind == PHASE_DRAINE)
        p = draine_eval(v.phase.g, v.phase.alpha, hg_from_peak(v.phase.g, before, after));
    else if (kind == PHASE_DROPLETS)
        p = droplets_eval(v.phase, before, after);
    else if (kind == PHASE_TABLE)
        p = table_eval(v.phase, before, after);
    return p;
}

// Whether there is a closed form of two scatterings.
const bool PHASE_HAS_TWICE = (int(PHASE == PHASE_HENYEY_GREENSTEIN) | int(PHASE == PHASE_RAYLEIGH) |
                              int(PHASE == PHASE_DOUBLE_HENYEY_GREENSTEIN)) != 0;

// After two scatterings: the mean of phase_eval(drawn, after) over what phase_sample draws from `before`. Henyey and
// Greenstein's functions are closed under convolution, asymmetries multiply.
float phase_eval_twice(MediumParams v, vec3 before, vec3 after) {
    float p = 0.0;
    if (PHASE == PHASE_HENYEY_GREENSTEIN)
        p = hg_eval(v.phase.g * v.phase.g, hg_from_peak(v.phase.g * v.phase.g, before, after));
    else if (PHASE == PHASE_RAYLEIGH)
        p = rayleigh_eval_twice(v.phase.share, dot(before, after));
    else if (PHASE == PHASE_DOUBLE_HENYEY_GREENSTEIN)
        p = double_hg_eval_twice(v.phase, before, after);
    return p;
}

// Of the directions that are off `toward` by an angle of this sine, or less, those next to going straight on and next to going back: the
// higher density of the two. A sine of 1 or more: of all directions.
float phase_peak(MediumParams v, vec3 travel, vec3 toward, float sine) {
    float mean = clamp(dot(travel, toward), -1.0, 1.0), cosine = sqrt(max(1.0 - sine * sine, 0.0));
    float rise = sqrt(max(1.0 - mean * mean, 0.0));
    float most = sine >= 1.0 || mean >= cosine ? 1.0 : mean * cosine + rise * sine;
    float least = sine >= 1.0 || -mean >= cosine ? -1.0 : mean * cosine - rise * sine;
    vec3 before = vec3(0.0, 1.0, 0.0);
    return max(phase_eval(v, before, vec3(sqrt(max(1.0 - most * most, 0.0)), most, 0.0)),
               phase_eval(v, before, vec3(sqrt(max(1.0 - least * least, 0.0)), least, 0.0)));
}

// A direction distributed as phase_eval; u in [0, 1)^2.
vec3 phase_sample(MediumParams v, vec3 before, vec2 u) {
    vec3 after = before;
    const int kind = KIND(PHASE, v, phase);
    if (kind == PHASE_HENYEY_GREENSTEIN)
        after = hg_sample(v.phase.g, before, u);
    else if (kind == PHASE_RAYLEIGH)
        after = turned(before, 1.0 - rayleigh_sample_cosine(v.phase.share, u.x), u.y);
    else if (kind == PHASE_DOUBLE_HENYEY_GREENSTEIN)
        after = double_hg_sample(v.phase, before, u);
    else if (kind == PHASE_DRAINE)
        after = draine_sample(v.phase.g, v.phase.alpha, before, u);
    else if (kind == PHASE_DROPLETS)
        after = droplets_sample(v.phase, before, u);
    else if (kind == PHASE_TABLE)
        after = table_sample(v.phase, before, u);
    return after;
}

#endif
