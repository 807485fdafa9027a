// Henyey-Greenstein phase function. mu is the cosine between *propagation* directions, before and after:
// g > 0 scatters forward, mu near 1. All functions work with the distance from the peak, 1 - mu for g >= 0 and 1 + mu
// for g < 0, which keeps its digits where the function is steep.
#ifndef HENYEY_GREENSTEIN_GLSL
#define HENYEY_GREENSTEIN_GLSL
#include "lib/directions.glsl"

// The distance from the peak. |a - b|^2 / 2 is 1 - a.b for unit vectors, with all digits where they nearly agree.
float hg_from_peak(float g, vec3 before, vec3 after) {
    vec3 apart = g < 0.0 ? before + after : before - after;
    return 0.5 * dot(apart, apart);
}

// Per steradian; integrates to 1 over the sphere. (1 - |g|)^2 + 2 |g| x is 1 + g^2 - 2 g mu without cancellation.
float hg_eval(float g, float from_peak) {
    float a = abs(g);
    float d = (1.0 - a) * (1.0 - a) + 2.0 * a * from_peak;
    return INV_4PI * (1.0 - a) * (1.0 + a) / (d * sqrt(d));
}

// The distance from the peak, in [0, 2], distributed as hg_eval, for u in [0, 1); mu rises with u. With a = |g|,
// s = 2u - 1 (1 - 2u for g < 0) and q = 1 + a s the inverse of the cumulative distribution is
// (1 - a)^2 + 2 a x = (1 - a^2)^2 / q^2. Solved for x, using (1 + a)^2 - q^2 = a (1 - s) (2 + a (1 + s)), the division
// by a cancels: nothing special happens at g = 0.
float hg_sample_from_peak(float g, float u) {
    float a = abs(g);
    float s_rest = g < 0.0 ? 2.0 * u : 2.0 * (1.0 - u); // 1 - s
    float q = 1.0 + a * (1.0 - s_rest);
    float value = (1.0 - a) * (1.0 - a) * s_rest * (2.0 + a * (2.0 - s_rest)) / (2.0 * q * q);
    return clamp(value, 0.0, 2.0);
}

// New unit direction of travel; u in [0, 1)^2.
vec3 hg_sample(float g, vec3 direction, vec2 u) {
    return turned(g < 0.0 ? -direction : direction, hg_sample_from_peak(g, u.x), u.y);
}

#endif
