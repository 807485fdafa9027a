// Rayleigh's phase function, of what is far smaller than the wavelength, without depolarisation: 3 / 16 pi (1 + mu^2).
#ifndef RAYLEIGH_GLSL
#define RAYLEIGH_GLSL
#include "lib/directions.glsl"

// Per steradian; integrates to 1 over the sphere.
float rayleigh_eval(float mu) {
    return 0.75 * INV_4PI * (1.0 + mu * mu);
}

// In Legendre polynomials it is (1 + P2 / 2) / 4 pi, whose moments 1 and 1/10 are multiplied by a second scattering.
float rayleigh_eval_twice(float mu) {
    return INV_4PI * (1.0 + 0.05 * (1.5 * mu * mu - 0.5));
}

// The cosine with u below it, rising with u in [0, 1): (mu^3 + 3 mu + 4) / 8 = u. With mu = t - 1 / t that is
// t^3 = w + sqrt(w^2 + 1), w = 4 u - 2 (Frisvad, "Importance Sampling the Rayleigh Phase Function", 2011); of |w|, so that
// nothing cancels.
float rayleigh_sample_cosine(float u) {
    float w = 4.0 * u - 2.0;
    float t = pow(abs(w) + sqrt(w * w + 1.0), 1.0 / 3.0);
    float mu = t - 1.0 / t;
    return clamp(w < 0.0 ? -mu : mu, -1.0, 1.0);
}

#endif
