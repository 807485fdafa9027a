// Flights that know the density they have passed (analytic, regular, marches) in a medium whose extinction differs
// between colour channels: the distance is sampled for one channel, chosen by its throughput, and weighted by the
// balance heuristic over all three (one-sample MIS; Wilkie et al., "Hero Wavelength Spectral Sampling", 2014).
// In a grey medium every weight here is 1.
#ifndef CHANNEL_GLSL
#define CHANNEL_GLSL
#include "majorants/majorant.glsl"

// Optical depth of the next collision, in terms of the largest channel's extinction. `e`: unit exponential; `select` in
// [0, 1) chooses the channel.
float sample_depth(MediumParams v, Spectrum beta, float e, float select) {
#ifdef CHROMATIC
    vec3 p = abs(beta);
    float at = select * total(p);
    float ratio = at < p.x ? v.sigma_ratio.x : at < p.x + p.y ? v.sigma_ratio.y : v.sigma_ratio.z;
    return ratio > 0.0 ? e / ratio : FAR;
#else
    return e;
#endif
}

// Weight of a flight that collided after passing the density integral `depth`, or that got so far. Exponentials are
// relative to the least extinct channel's, which cannot vanish all.
Spectrum depth_weight(MediumParams v, Spectrum beta, float depth, bool collided) {
#ifdef CHROMATIC
    vec3 T = exp(-v.sigma_t * (v.sigma_ratio - smallest(v.sigma_ratio)) * depth);
    vec3 density = collided ? v.sigma_ratio * T : T;
    float mean = dot(abs(beta), density);
    return mean > 0.0 ? density * total(abs(beta)) / mean : vec3(0.0);
#else
    return 1.0;
#endif
}

#endif
