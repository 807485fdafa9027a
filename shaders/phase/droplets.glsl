// Droplets of water, as in fog and clouds: a share of the light goes by Draine's phase function, the rest by Henyey and
// Greenstein's, which is close to Mie's theory without its rainbows (Jendersie and d'Eon, "An Approximate Mie
// Scattering Function for Fog and Cloud Rendering", 2023). Which of each is host/assets/phase_params.cpp's to say.
#ifndef DROPLETS_GLSL
#define DROPLETS_GLSL
#include "phase/draine.glsl"

float droplets_eval(PhaseParams p, vec3 before, vec3 after) {
    return mix(hg_eval(p.g, hg_from_peak(p.g, before, after)),
               draine_eval(p.g2, p.alpha, hg_from_peak(p.g2, before, after)), p.share);
}

// With alpha 0 Draine's is Henyey and Greenstein's: lanes that draw from either go one way.
vec3 droplets_sample(PhaseParams p, vec3 before, vec2 u) {
    bool second = u.x < p.share;
    u.x = second ? u.x / p.share : (u.x - p.share) / (1.0 - p.share);
    return draine_sample(second ? p.g2 : p.g, second ? p.alpha : 0.0, before, u);
}

#endif
