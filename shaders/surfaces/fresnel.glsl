// What a smooth boundary reflects of unpolarised light, by Fresnel's equations. `cosine`: of the incident direction, in [0, 1].
#ifndef FRESNEL_GLSL
#define FRESNEL_GLSL

// eta: index of refraction beyond the boundary over that before it, > 0.
float fresnel_dielectric(float cosine, float eta) {
    float square = 1.0 - (1.0 - cosine * cosine) / (eta * eta); // of the refracted direction's cosine
    float beyond = sqrt(max(square, 0.0));
    float parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
    float across = (cosine - eta * beyond) / (cosine + eta * beyond);
    return square > 0.0 ? 0.5 * (parallel * parallel + across * across) : 1.0;
}

// eta + i k: a conductor's index over that before it. In real numbers (Lagarde, "Memo on Fresnel Equations", 2013). Of
// index 1 at cosine 0: 0.
vec3 fresnel_conductor(float cosine, vec3 eta, vec3 k) {
    float c = cosine * cosine, s = 1.0 - c;
    vec3 eta2 = eta * eta, k2 = k * k;
    vec3 t0 = eta2 - k2 - s;
    vec3 both = sqrt(t0 * t0 + 4.0 * eta2 * k2); // a^2 + b^2
    vec3 a = sqrt(max(0.5 * (both + t0), vec3(0.0)));
    vec3 across = (both + c - 2.0 * a * cosine) / max(both + c + 2.0 * a * cosine, vec3(1.0e-30));
    vec3 parallel = across * (c * both + s * s - 2.0 * a * cosine * s) / (c * both + s * s + 2.0 * a * cosine * s);
    return 0.5 * (across + parallel);
}

#endif
