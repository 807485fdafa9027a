// How surfaces scatter: value, density and sampler of each kind, one switch. `wo`, `wi`: unit, away from the surface, towards where
// the path came from and where it goes.
#ifndef BSDF_GLSL
#define BSDF_GLSL
#include "lib/buffers.glsl"
#include "surfaces/microsurface.glsl"
#include "surfaces/texture.glsl"

struct Bsdf {
    uint material;
    vec3 normal; // unit, on wo's side
    vec3 face;   // likewise, of the face itself, where it stands for something smooth
    vec3 smooth_normal; // likewise, of what it stands for
    vec3 color;
    vec3 eta; // beyond the surface over before it
    vec3 k;   // of what is coated, x: share of diffuse light that the coat throws back at it
    float alpha;
    uvec4 key; // of the walks among facets of what is rough; and, turned about, of bsdf_guess
};

struct BsdfSample {
    vec3 direction;
    vec3 weight; // value over density
    float pdf;   // bsdf_pdf; 0: of one direction, or one of two
};

bool has_material(uint material) {
    return (MATERIALS & 1 << material) != 0;
}

// Whether any surface has facets: then each vertex on a surface takes a draw for the key of its walks.
bool takes_walks() {
    return has_material(MATERIAL_ROUGH_CONDUCTOR) || has_material(MATERIAL_ROUGH_DIELECTRIC);
}

bool is_glass(uint material) {
    return material == MATERIAL_DIELECTRIC || material == MATERIAL_ROUGH_DIELECTRIC;
}

// Whether w is before the face and behind what it stands for, or the other way.
bool is_between(Bsdf b, vec3 normal, vec3 w) {
    return HAS_SMOOTH_FACES && (dot(normal, w) > 0.0) != (dot(b.face, w) > 0.0);
}

// As it is for a path that comes along -w: where the smooth surface would be seen from behind, as at edges, the face is what it is.
Bsdf as_seen_along(Bsdf b, vec3 w) {
    b.normal = is_between(b, b.smooth_normal, w) ? b.face : b.smooth_normal;
    return b;
}

Bsdf bsdf_of(SurfaceRow row, SurfacePoint at, vec3 wo, uvec4 key) {
    bool inside = dot(at.normal, wo) < 0.0;
    bool turns = inside && is_glass(row.material);
    float side = inside ? -1.0 : 1.0;
    vec3 face = side * at.normal;
    Bsdf b = Bsdf(row.material, face, face, side * at.smooth_normal, row.color, turns ? 1.0 / row.eta : row.eta, row.k, row.roughness, key);
    return HAS_SMOOTH_FACES ? as_seen_along(b, wo) : b;
}

// Whether light does not go from one to the other, since it would come out on another side of the face than of what that stands for.
bool is_barred(Bsdf b, vec3 wo, vec3 wi) {
    return is_between(b, b.normal, wo) || is_between(b, b.normal, wi);
}

bool has_facets(Bsdf b) {
    return takes_walks() && (b.material == MATERIAL_ROUGH_CONDUCTOR || b.material == MATERIAL_ROUGH_DIELECTRIC);
}

Facets facets_of(Bsdf b) {
    return Facets(b.alpha, b.material == MATERIAL_ROUGH_CONDUCTOR, b.eta, b.k);
}

// Whether it scatters into all directions, so that looking for light makes sense.
bool is_rough(Bsdf b) {
    return b.material == MATERIAL_DIFFUSE || b.material == MATERIAL_COATED || has_facets(b);
}

// Whether light ends there.
bool is_black(Bsdf b) {
    return largest(b.color) == 0.0 && b.material != MATERIAL_COATED;
}

vec3 to_frame(vec3 normal, vec3 w) {
    vec3 tangent, bitangent;
    build_frame(normal, tangent, bitangent);
    return vec3(dot(tangent, w), dot(bitangent, w), dot(normal, w));
}

vec3 from_frame(vec3 normal, vec3 w) {
    vec3 tangent, bitangent;
    build_frame(normal, tangent, bitangent);
    return normalize(tangent * w.x + bitangent * w.y + normal * w.z);
}

// What a smooth coat lets in and out again of what is diffuse below it, over what the latter alone would scatter. Between them light
// goes to and fro: the sum of a geometric series.
vec3 through_coat(Bsdf b, float in_cosine, float out_cosine) {
    float passes = (1.0 - fresnel_dielectric(in_cosine, b.eta.x)) * (1.0 - fresnel_dielectric(out_cosine, b.eta.x));
    return passes / (b.eta * b.eta * (1.0 - b.color * b.k.x));
}

// Times the cosine of wi; 0 for what has but single directions. An estimate, where there are facets.
vec3 bsdf_value(Bsdf b, vec3 wo, vec3 wi) {
    float cosine = max(dot(b.normal, wi), 0.0);
    vec3 value = is_rough(b) ? b.color * (cosine / PI) : vec3(0.0);
    if (has_material(MATERIAL_COATED))
        if (b.material == MATERIAL_COATED)
            value *= through_coat(b, cosine, min(dot(b.normal, wo), 1.0));
    if (has_facets(b))
        value = b.color * facets_value(facets_of(b), to_frame(b.normal, wo), to_frame(b.normal, wi),
                                       Rng(b.key.x, b.key.y, b.key.z, b.key.w));
    return is_barred(b, wo, wi) ? vec3(0.0) : value;
}

// What decides between ways to find light, which may be any density; with this one bsdf_guess draws.
float bsdf_pdf(Bsdf b, vec3 wo, vec3 wi) {
    float pdf = is_rough(b) ? max(dot(b.normal, wi), 0.0) / PI : 0.0;
    if (has_facets(b))
        pdf = facets_guess_pdf(facets_of(b), to_frame(b.normal, wo), to_frame(b.normal, wi));
    return pdf;
}

vec3 bsdf_guess(Bsdf b, vec3 wo, vec2 u) {
    vec3 direction = by_cosine(b.normal, u);
    if (has_facets(b)) {
        vec2 choice = to_uniform(pcg4d(b.key.yzwx)).xy;
        direction = from_frame(b.normal, facets_guess(facets_of(b), to_frame(b.normal, wo), u, choice));
    }
    return direction;
}

// By what the value differs where light comes from wo and goes to wi. Radiance goes with the square of the index, and particles do not; and
// where the normal is not the face's, one cosine is the light's and the other the face's (Veach, "Robust Monte Carlo Methods for
// Light Transport Simulation", 1997, equations 5.12 and 5.19).
float bsdf_adjoint(Bsdf b, vec3 wo, vec3 wi) {
    bool crosses = is_glass(b.material) && dot(b.face, wi) < 0.0;
    float factor = crosses ? b.eta.x * b.eta.x : 1.0;
    if (HAS_SMOOTH_FACES && b.normal != b.face)
        factor *= abs(dot(wo, b.normal) * dot(wi, b.face)) / max(abs(dot(wo, b.face) * dot(wi, b.normal)), 1.0e-12);
    return factor;
}

// Which normal counts, the path from the camera decides: it comes along -wi where a particle comes along -wo. So a particle draws one
// before it draws wi: the face's with this chance, the cosine-weighted part of all directions that do not see the other; or the other, if
// light comes to it.
// (1 - cos) / 2 of the angle between them, by a difference that is 0 where they are equal.
float face_chance(Bsdf b, vec3 wo) {
    vec3 between = b.smooth_normal - b.face;
    return is_between(b, b.smooth_normal, wo) ? 1.0 : 0.25 * dot(between, between);
}

// `weight`: of what is then drawn with it, if that does see it.
Bsdf particle_bsdf(Bsdf b, vec3 wo, inout float u, out float weight) {
    float chance = face_chance(b, wo);
    bool is_face = u < chance;
    b.normal = is_face ? b.face : b.smooth_normal;
    weight = 1.0 / max(is_face ? chance : 1.0 - chance, 1.0e-6);
    u = (is_face ? u : u - chance) * weight;
    return b;
}
bool has_drawn_as_seen(Bsdf b, vec3 wi) {
    return b.normal == as_seen_along(b, wi).normal;
}

// Mirrored, or refracted with chance 1 - F. Radiance goes with the square of the index, hence eta^2 where it crosses.
BsdfSample sample_dielectric(Bsdf b, vec3 wo, float u) {
    float cosine = min(dot(b.normal, wo), 1.0);
    float eta = b.eta.x;
    bool reflects = u < fresnel_dielectric(cosine, eta);
    vec3 direction = reflects ? normalize(2.0 * cosine * b.normal - wo) : refracted(wo, b.normal, cosine, eta);
    return BsdfSample(direction, reflects ? b.color : b.color / (eta * eta), 0.0);
}

// Light goes to and fro between the two sides, F F + (1 - F)^2 F (1 + F^2 + ...) of it back in all, and what passes goes on as it came.
BsdfSample sample_pane(Bsdf b, vec3 wo, float u) {
    float cosine = min(dot(b.normal, wo), 1.0);
    float F = fresnel_dielectric(cosine, b.eta.x);
    bool reflects = u * (1.0 + F) < 2.0 * F;
    return BsdfSample(reflects ? normalize(2.0 * cosine * b.normal - wo) : -wo, b.color, 0.0);
}

// The coat mirrors F of the light, and what is below it scatters its albedo of the rest: which of them the path takes is drawn by what
// is left of it then, `carried` before, whatever its sign.
BsdfSample sample_coated(Bsdf b, vec3 wo, vec3 carried, vec3 u) {
    float cosine = min(dot(b.normal, wo), 1.0);
    float F = fresnel_dielectric(cosine, b.eta.x);
    vec3 direction = by_cosine(b.normal, u.xy);
    float out_cosine = max(dot(b.normal, direction), 0.0);
    float mirrored = F * dot(abs(carried), vec3(1.0));
    float scattered = (1.0 - F) * dot(abs(carried), (1.0 - b.k.x) * b.color / max(1.0 - b.k.x * b.color, 1.0e-7));
    float chance = mirrored > 0.0 ? mirrored / (mirrored + scattered) : 0.0;
    vec3 below = b.color * through_coat(b, out_cosine, cosine) / max(1.0 - chance, 1.0e-7);
    bool mirrors = u.z < chance;
    return BsdfSample(mirrors ? normalize(2.0 * cosine * b.normal - wo) : direction, mirrors ? vec3(F / max(chance, 1.0e-30)) : below,
                      mirrors ? 0.0 : out_cosine / PI);
}

BsdfSample sample_facets(Bsdf b, vec3 wo) {
    BsdfSample drawn;
    vec3 wi = facets_sample(facets_of(b), to_frame(b.normal, wo), Rng(b.key.x, b.key.y, b.key.z, b.key.w), drawn.weight);
    drawn.direction = from_frame(b.normal, wi);
    drawn.weight *= b.color;
    drawn.pdf = bsdf_pdf(b, wo, drawn.direction);
    return drawn;
}

// `carried`: throughput of the path, which may decide what is drawn.
BsdfSample bsdf_sample(Bsdf b, vec3 wo, vec3 carried, vec3 u) {
    float cosine = min(dot(b.normal, wo), 1.0);
    BsdfSample drawn;
    drawn.direction = by_cosine(b.normal, u.xy);
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
    if (has_material(MATERIAL_THIN_DIELECTRIC))
        if (b.material == MATERIAL_THIN_DIELECTRIC)
            drawn = sample_pane(b, wo, u.z);
    if (has_material(MATERIAL_COATED))
        if (b.material == MATERIAL_COATED)
            drawn = sample_coated(b, wo, carried, u);
    if (has_facets(b))
        drawn = sample_facets(b, wo);
    drawn.weight *= is_barred(b, wo, drawn.direction) ? 0.0 : 1.0;
    return drawn;
}

#endif
