// Rayleigh's phase function, of what is far smaller than the wavelength: 3 / 16 pi (1 + mu^2). Where what scatters is not round, it takes
// polarisation from the light, and a part of what it scatters goes evenly; `share` is the other part, >= 0.1.
#ifndef RAYLEIGH_GLSL
#define RAYLEIGH_GLSL
#include "lib/directions.glsl"

// Per steradian; integrates to 1 over the sphere.
float rayleigh_eval(float share, float mu) {
    return INV_4PI * mix(1.0, 0.75 + 0.75 * mu * mu, share);
}

// In Legendre polynomials it is (1 + share P2 / 2) / 4 pi, whose moments 1 and share / 10 are multiplied by a second scattering.
float rayleigh_eval_twice(float share, float mu) {
    return INV_4PI * (1.0 + 0.05 * share * share * (1.5 * mu * mu - 0.5));
}

// The cosine with u below it, rising with u in [0, 1): (mu^3 + 3 a mu + c) share / 8 = u with a = 4 / (3 share) - 1 / 3, which is 1 if share is.
// With mu = t - a / t that is t^3 = w + sqrt(w^2 + a^3), w = (4 u - 2) / share (after Frisvad, "Importance Sampling the Rayleigh Phase
// Function", 2011); of |w|, so that nothing cancels there.
float rayleigh_sample_cosine(float share, float u) {
    float w = (4.0 * u - 2.0) / share;
    float a = (4.0 / share - 1.0) / 3.0;
    float t = pow(abs(w) + sqrt(w * w + a * a * a), 1.0 / 3.0);
    float mu = t - a / t;
    return clamp(w < 0.0 ? -mu : mu, -1.0, 1.0);
}

#endif
