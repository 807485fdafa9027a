// Henyey-Greenstein phase function. mu is the cosine between *propagation* directions, before and after:
// g > 0 scatters forward, mu near 1. All functions work with 1 - mu, which keeps its digits near the peak.
#ifndef PHASE_GLSL
#define PHASE_GLSL

const float INV_4PI = 0.07957747154594767;

// Per steradian; integrates to 1 over the sphere. (1 - g)^2 + 2 g (1 - mu) is 1 + g^2 - 2 g mu without cancellation.
float hg_eval(float g, float one_minus_mu) {
    float d = (1.0 - g) * (1.0 - g) + 2.0 * g * one_minus_mu;
    return INV_4PI * (1.0 - g * g) / (d * sqrt(d));
}

// 1 - mu in [0, 2] distributed as hg_eval, for u in [0, 1). With s = 2u - 1 and q = 1 + g s the inverse of the
// cumulative distribution is (1 - g)^2 + 2 g (1 - mu) = (1 - g^2)^2 / q^2. Solved for 1 - mu, using
// (1 + g)^2 - q^2 = g (1 - s) (2 + g (1 + s)), the division by g cancels: nothing special happens at g = 0.
float hg_sample_one_minus_mu(float g, float u) {
    float s_rest = 2.0 * (1.0 - u); // 1 - s
    float q = 1.0 + g * (1.0 - s_rest);
    float value = (1.0 - g) * (1.0 - g) * s_rest * (2.0 + g * (2.0 - s_rest)) / (2.0 * q * q);
    return clamp(value, 0.0, 2.0);
}

// Two unit vectors that complete `n` to a right-handed frame (Duff et al., "Building an Orthonormal Basis,
// Revisited", 2017); continuous but at one pole, where the sign keeps it finite.
void build_frame(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float sign_z = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign_z + n.z);
    float b = n.x * n.y * a;
    tangent = vec3(1.0 + sign_z * n.x * n.x * a, sign_z * b, -sign_z * n.x);
    bitangent = vec3(b, sign_z + n.y * n.y * a, -n.y);
}

// New unit direction of travel; u in [0, 1)^2.
vec3 hg_sample(float g, vec3 direction, vec2 u) {
    float one_minus_mu = hg_sample_one_minus_mu(g, u.x);
    float sine = sqrt(one_minus_mu * (2.0 - one_minus_mu));
    float phi = 6.283185307179586 * u.y;
    vec3 tangent, bitangent;
    build_frame(direction, tangent, bitangent);
    vec3 turned = direction * (1.0 - one_minus_mu) + (tangent * cos(phi) + bitangent * sin(phi)) * sine;
    return normalize(turned);
}

#endif
