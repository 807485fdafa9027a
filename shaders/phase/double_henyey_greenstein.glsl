// Two of Henyey and Greenstein's phase functions: a share of the light goes by the second. One forward and one backward is what
// tissue and dust are often fitted with.
#ifndef DOUBLE_HENYEY_GREENSTEIN_GLSL
#define DOUBLE_HENYEY_GREENSTEIN_GLSL
#include "phase/henyey_greenstein.glsl"

float double_hg_eval(PhaseParams p, vec3 before, vec3 after) {
    return mix(hg_eval(p.g, hg_from_peak(p.g, before, after)), hg_eval(p.g2, hg_from_peak(p.g2, before, after)), p.share);
}

// Each after each: see phase_eval_twice.
float double_hg_eval_twice(PhaseParams p, vec3 before, vec3 after) {
    float first = p.g * p.g, both = p.g * p.g2, second = p.g2 * p.g2;
    float one = hg_eval(both, hg_from_peak(both, before, after));
    return mix(mix(hg_eval(first, hg_from_peak(first, before, after)), one, p.share),
               mix(one, hg_eval(second, hg_from_peak(second, before, after)), p.share), p.share);
}

vec3 double_hg_sample(PhaseParams p, vec3 before, vec2 u) {
    bool second = u.x < p.share;
    u.x = second ? u.x / p.share : (u.x - p.share) / (1.0 - p.share);
    return hg_sample(second ? p.g2 : p.g, before, u);
}

#endif
