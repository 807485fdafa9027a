// Draine's phase function ("Scattering by Interstellar Dust Grains", 2003): Henyey and Greenstein's times 1 + alpha mu^2,
// normalised. With alpha 0 it is theirs, with 1 Cornette and Shanks's.
#ifndef DRAINE_GLSL
#define DRAINE_GLSL
#include "phase/henyey_greenstein.glsl"

// The integral of hg_eval (1 + alpha mu^2) over the sphere.
float draine_norm(float g, float alpha) {
    return 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
}

// Per steradian; integrates to 1 over the sphere.
float draine_eval(float g, float alpha, float from_peak) {
    float mu = 1.0 - from_peak;
    return hg_eval(g, from_peak) * (1.0 + alpha * mu * mu) / draine_norm(g, alpha);
}

// The distance from the peak, in [0, 2], distributed as draine_eval and rising with u in [0, 1).
//
// The unknown is h, which Henyey and Greenstein's distribution has below that distance: by h the derivative of Draine's is
// (1 + alpha mu^2) / norm, neither small nor large however sharp the peak. With a = |g|, q the root in hg_eval's
// denominator, and r = (q - 1 + a) / 2a, which goes from 0 to 1: the distance is x = 2 r (1 - a + a r), h = (1 + a) r / q,
// and the integral of mu^2 over h, by parts, mu^2 h + 2 (1 + a) r^2 (1 - 4/3 (1 - a) r - a r^2). Nowhere does a divide.
// Newton's steps, between bounds: six are enough to single precision for alpha = 35, ten for 250.
float draine_sample_from_peak(float g, float alpha, float u) {
    float a = abs(g);
    float rest = 1.0 - a;
    float wanted = u * draine_norm(g, alpha);
    float low = 0.0, high = 1.0, h = u, x = 0.0;
    for (int i = 0; i < 10; ++i) {
        float r = h * rest / (1.0 + a - 2.0 * a * h);
        x = 2.0 * r * (rest + a * r);
        float square = (1.0 - x) * (1.0 - x);
        float moment = square * h + 2.0 * (1.0 + a) * r * r * (1.0 - 4.0 / 3.0 * rest * r - a * r * r);
        float excess = h + alpha * moment - wanted;
        low = excess < 0.0 ? h : low;
        high = excess < 0.0 ? high : h;
        float next = h - excess / (1.0 + alpha * square);
        h = next >= low && next <= high ? next : 0.5 * (low + high);
    }
    return clamp(x, 0.0, 2.0);
}

// New unit direction of travel; u in [0, 1)^2.
vec3 draine_sample(float g, float alpha, vec3 direction, vec2 u) {
    return turned(g < 0.0 ? -direction : direction, draine_sample_from_peak(g, alpha, u.x), u.y);
}

#endif
