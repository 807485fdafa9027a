// A rough boundary: a random walk from facet to facet, mirrors or panes of glass, after which nothing is lost but what they take
// (Heitz, Hanika, d'Eon, Dachsbacher, "Multiple-Scattering Microfacet BSDFs with the Smith Model", 2016). Slopes of facets have
// the distribution GGX of roughness alpha. Of heights the walk knows only c, the share of the boundary that is lower: their
// distribution changes no result.
//
// Directions are in a frame whose z is the normal on the side where light is on its way. As it crosses a facet all is turned
// about, x to -x, and what was lower is higher: c to 1 - c.
//
// Bias: after MOST_FACETS facets light leaves by cosine. Fewer than one walk in 10^6 is that long (tools/results/README.md).
#ifndef MICROSURFACE_GLSL
#define MICROSURFACE_GLSL
#include "lib/directions.glsl"
#include "lib/rng.glsl"
#include "surfaces/fresnel.glsl"

struct Facets {
    float alpha;
    bool conducts;
    vec3 eta; // of a dielectric: beyond over before, as the path came
    vec3 k;
};

// Smith's Lambda: light on its way along w passes all that is higher than c with chance c^Lambda, or if it goes down, with none.
float smith_lambda(vec3 w, float alpha) {
    float across = alpha * alpha * dot(w.xy, w.xy);
    float up = max(w.z * w.z, 1.0e-30);
    float root = sqrt(1.0 + across / up);
    return w.z > 0.0 ? 0.5 * across / (up * (1.0 + root)) : -0.5 * (1.0 + root);
}

// Projected area of facets as seen along -wi, per area of the boundary.
float projected_area(vec3 wi, float alpha) {
    float across = alpha * alpha * dot(wi.xy, wi.xy);
    float root = sqrt(wi.z * wi.z + across);
    return wi.z > 0.0 ? 0.5 * (wi.z + root) : 0.5 * across / (root - wi.z);
}

// Density of normals m, per steradian and area of the boundary.
float ggx(vec3 m, float alpha) {
    float s = dot(m.xy, m.xy) / (alpha * alpha) + m.z * m.z;
    return m.z > 0.0 ? 1.0 / (PI * alpha * alpha * s * s) : 0.0;
}

// The normal of one of the facets that are seen along -wi (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps",
// 2023), which need not come from above.
vec3 visible_facet(vec3 wi, float alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * wi.xy, wi.z));
    float z = 1.0 - u.x * (1.0 + stretched.z);
    float phi = 2.0 * PI * (u.y - 0.5);
    vec2 around = normalize(vec2(cos(phi), sin(phi)));
    vec3 m = vec3(sqrt(max(1.0 - z * z, 0.0)) * around, z) + stretched;
    return normalize(vec3(alpha * m.xy, max(m.z, 1.0e-7)));
}

vec3 refracted(vec3 wi, vec3 m, float cosine, float eta) {
    float beyond = sqrt(max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
    return normalize((cosine / eta - beyond) * m - wi / eta);
}

// What facets would mirror from -wi to wo, per steradian, if they mirrored all.
float facets_mirror_all(float alpha, vec3 wi, vec3 wo) {
    vec3 m = normalize(wi + wo);
    return m.z > 0.0 && dot(wi, m) > 0.0 ? 0.25 * ggx(m, alpha) / projected_area(wi, alpha) : 0.0;
}

vec3 facets_mirror(Facets f, float eta, vec3 wi, vec3 wo) {
    float cosine = dot(wi, normalize(wi + wo));
    vec3 F = f.conducts ? fresnel_conductor(cosine, f.eta, f.k) : vec3(fresnel_dielectric(cosine, eta));
    return facets_mirror_all(f.alpha, wi, wo) * F;
}

// What they let through (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007).
float facets_pass(float alpha, float eta, vec3 wi, vec3 wo) {
    vec3 m = normalize(wi + eta * wo);
    m = m.z > 0.0 ? m : -m;
    float cosine = dot(wi, m), beyond = dot(wo, m), both = cosine + eta * beyond;
    return cosine > 0.0 && beyond < 0.0 ? ggx(m, alpha) / projected_area(wi, alpha) * cosine *
                                              (1.0 - fresnel_dielectric(cosine, eta)) * eta * eta * -beyond / (both * both)
                                        : 0.0;
}

// Chance to leave along w from where c of the boundary is lower.
float leaving_chance(vec3 w, float c, float alpha) {
    return w.z > 0.0 ? pow(max(c, 1.0e-30), smith_lambda(w, alpha)) : 0.0;
}

// Where a walk is.
struct FacetWalk {
    vec3 w; // on its way along this
    float c;
    float eta;
    float side; // 1: that where it began; -1
    vec3 weight;
    bool left;
};

FacetWalk begin_facet_walk(Facets f, vec3 wo) {
    return FacetWalk(-wo, 1.0, f.eta.x, 1.0, vec3(1.0), false);
}

// As far as the next facet, or away.
void walk_to_facet(float alpha, float u, inout FacetWalk walk) {
    float lambda = smith_lambda(walk.w, alpha);
    walk.left = u >= 1.0 - leaving_chance(walk.w, walk.c, alpha);
    walk.c = walk.left ? walk.c : min(walk.c * pow(1.0 - u, -1.0 / lambda), 1.0);
}

// Mirrored by it, or through it.
void meet_facet(Facets f, vec3 u, inout FacetWalk walk) {
    vec3 wi = -walk.w;
    vec3 m = visible_facet(wi, f.alpha, u.xy);
    float cosine = clamp(dot(wi, m), 0.0, 1.0);
    bool crosses = !f.conducts && u.z >= fresnel_dielectric(cosine, walk.eta);
    walk.weight *= f.conducts ? fresnel_conductor(cosine, f.eta, f.k) : vec3(1.0);
    walk.w = crosses ? -refracted(wi, m, cosine, walk.eta) : normalize(2.0 * cosine * m - wi);
    walk.c = crosses ? 1.0 - walk.c : walk.c;
    walk.side = crosses ? -walk.side : walk.side;
    walk.eta = crosses ? 1.0 / walk.eta : walk.eta;
}

// A direction, in the frame of wo, and in `weight` what it is worth.
vec3 facets_sample(Facets f, vec3 wo, Rng rng, out vec3 weight) {
    FacetWalk walk = begin_facet_walk(f, wo);
    vec4 u;
    for (int i = 0; i < MOST_FACETS && !walk.left; ++i) {
        u = to_uniform(next_words(rng));
        walk_to_facet(f.alpha, u.x, walk);
        if (!walk.left)
            meet_facet(f, u.yzw, walk);
    }
    u = to_uniform(next_words(rng));
    if (!walk.left && u.x >= leaving_chance(walk.w, walk.c, f.alpha))
        walk.w = by_cosine(vec3(0.0, 0.0, 1.0), u.yz);
    weight = walk.side < 0.0 ? walk.weight / (f.eta.x * f.eta.x) : walk.weight;
    return walk.side * walk.w;
}

// An estimate of the value towards wi, times its cosine, which is right in the mean but for that: what leaves that way from every
// facet of a walk.
vec3 facets_value(Facets f, vec3 wo, vec3 wi, Rng rng) {
    FacetWalk walk = begin_facet_walk(f, wo);
    vec3 value = vec3(0.0);
    for (int i = 0; i < MOST_FACETS && !walk.left; ++i) {
        vec4 u = to_uniform(next_words(rng));
        walk_to_facet(f.alpha, u.x, walk);
        if (!walk.left) {
            vec3 to = walk.side * wi;
            if (to.z > 0.0)
                value += walk.weight * leaving_chance(to, walk.c, f.alpha) * facets_mirror(f, walk.eta, -walk.w, to);
            else if (!f.conducts)
                value += leaving_chance(-to, 1.0 - walk.c, f.alpha) * facets_pass(f.alpha, walk.eta, -walk.w, to);
            meet_facet(f, u.yzw, walk);
        }
    }
    if (!walk.left) {
        float stays = 1.0 - leaving_chance(walk.w, walk.c, f.alpha);
        value += walk.weight * stays * max(walk.side * wi.z, 0.0) / PI;
    }
    return wi.z < 0.0 && !f.conducts ? value / (f.eta.x * f.eta.x) : value;
}

// A direction by the first facet alone, or a tenth of the time by cosine, and the density of such: what a walk draws has none in
// closed form. For choosing and weighing, where any density will do.
const float BY_FACET = 0.9;

vec3 facets_guess(Facets f, vec3 wo, vec2 u, vec2 choice) {
    vec3 m = visible_facet(wo, f.alpha, u);
    float cosine = clamp(dot(wo, m), 0.0, 1.0);
    vec3 by_facet = normalize(2.0 * cosine * m - wo);
    if (!f.conducts && choice.x >= fresnel_dielectric(cosine, f.eta.x))
        by_facet = refracted(wo, m, cosine, f.eta.x);
    vec3 otherwise = by_cosine(vec3(0.0, 0.0, 1.0), u);
    if (!f.conducts && choice.x < 0.5)
        otherwise.z = -otherwise.z;
    return choice.y < BY_FACET ? by_facet : otherwise;
}

float facets_guess_pdf(Facets f, vec3 wo, vec3 wi) {
    float otherwise = (f.conducts ? max(wi.z, 0.0) : 0.5 * abs(wi.z)) / PI;
    float by_facet = f.conducts ? facets_mirror_all(f.alpha, wo, wi)
                                : facets_mirror(f, f.eta.x, wo, wi).x + facets_pass(f.alpha, f.eta.x, wo, wi);
    return mix(otherwise, by_facet, BY_FACET);
}

#endif
