// How surfaces scatter: value, density and sampler of each kind, one switch. `wo`, `wi`: unit, away from the surface, towards where
// the path came from and where it goes.
#ifndef BSDF_GLSL
#define BSDF_GLSL
#include "lib/buffers.glsl"
#include "lib/directions.glsl"
#include "surfaces/fresnel.glsl"

struct Bsdf {
    uint material;
    vec3 normal; // unit, on wo's side
    vec3 color;
    vec3 eta; // beyond the surface over before it
    vec3 k;
};

struct BsdfSample {
    vec3 direction;
    vec3 weight; // value over density
    float pdf;   // per steradian; 0: of one direction, or one of two
};

bool has_material(uint material) {
    return (MATERIALS & 1 << material) != 0;
}

Bsdf bsdf_of(SurfaceRow row, vec3 normal, vec3 wo) {
    bool inside = dot(normal, wo) < 0.0;
    bool turns = inside && row.material == MATERIAL_DIELECTRIC;
    return Bsdf(row.material, inside ? -normal : normal, row.color, turns ? 1.0 / row.eta : row.eta, row.k);
}

// Whether it scatters into all directions, so that looking for light makes sense.
bool is_rough(Bsdf b) {
    return b.material == MATERIAL_DIFFUSE;
}

// Times the cosine of wi; 0 for what has but single directions.
vec3 bsdf_value(Bsdf b, vec3 wo, vec3 wi) {
    return is_rough(b) ? b.color * (max(dot(b.normal, wi), 0.0) / PI) : vec3(0.0);
}

float bsdf_pdf(Bsdf b, vec3 wo, vec3 wi) {
    return is_rough(b) ? max(dot(b.normal, wi), 0.0) / PI : 0.0;
}

// Mirrored, or refracted with chance 1 - F. Radiance goes with the square of the index, hence eta^2 where it crosses.
BsdfSample sample_dielectric(Bsdf b, vec3 wo, float u) {
    float cosine = min(dot(b.normal, wo), 1.0);
    float eta = b.eta.x;
    float beyond = sqrt(max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
    bool reflects = u < fresnel_dielectric(cosine, eta);
    vec3 direction = reflects ? 2.0 * cosine * b.normal - wo : (cosine / eta - beyond) * b.normal - wo / eta;
    return BsdfSample(normalize(direction), reflects ? b.color : b.color / (eta * eta), 0.0);
}

BsdfSample bsdf_sample(Bsdf b, vec3 wo, vec3 u) {
    float cosine = min(dot(b.normal, wo), 1.0);
    // By cosine: from_peak = 1 - sqrt(1 - u), with all digits where that is small.
    BsdfSample drawn;
    drawn.direction = turned(b.normal, u.x / (1.0 + sqrt(1.0 - u.x)), u.y);
    drawn.weight = b.color;
    drawn.pdf = max(dot(b.normal, drawn.direction), 0.0) / PI;
    if (has_material(MATERIAL_MIRROR) || has_material(MATERIAL_CONDUCTOR))
        if (b.material == MATERIAL_MIRROR || b.material == MATERIAL_CONDUCTOR) {
            drawn.direction = normalize(2.0 * cosine * b.normal - wo);
            drawn.pdf = 0.0;
        }
    if (has_material(MATERIAL_CONDUCTOR))
        if (b.material == MATERIAL_CONDUCTOR)
            drawn.weight *= fresnel_conductor(cosine, b.eta, b.k);
    if (has_material(MATERIAL_DIELECTRIC))
        if (b.material == MATERIAL_DIELECTRIC)
            drawn = sample_dielectric(b, wo, u.z);
    return drawn;
}

#endif
