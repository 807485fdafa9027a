// What scatters light at a vertex: matter, by its phase function, or a surface. `before` and `after`: directions of propagation.
#ifndef SCATTERER_GLSL
#define SCATTERER_GLSL
#include "phase/phase.glsl"
#ifdef SURFACES
#include "surfaces/bsdf.glsl"

struct Scatterer {
    MediumParams medium;
    bool is_surface;
    Bsdf bsdf;
    float apart; // see SurfacePoint
};

Scatterer matter_of(MediumParams v) {
    Scatterer s;
    s.medium = v;
    s.is_surface = false;
    return s;
}

Scatterer surface_of(MediumParams v, Bsdf bsdf, float apart) {
    return Scatterer(v, true, bsdf, apart);
}

bool is_surface(Scatterer s) {
    return s.is_surface;
}

// Unit normal of the side that light is scattered from, or 0 if it is from all sides.
vec3 lit_side(Scatterer s) {
    return s.is_surface && s.bsdf.material != MATERIAL_ROUGH_DIELECTRIC ? s.bsdf.face : vec3(0.0);
}

// From `position` before the surface to where light arrives along -to_light: behind it, where that is.
vec3 lit_position(Scatterer s, vec3 position, vec3 to_light) {
    bool behind = has_material(MATERIAL_ROUGH_DIELECTRIC) && s.is_surface && dot(s.bsdf.face, to_light) < 0.0;
    return behind ? position - 2.0 * s.apart * s.bsdf.face : position;
}

// Share of light that is scattered into `after`, per steradian.
vec3 scatter_value(Scatterer s, vec3 before, vec3 after) {
    return s.is_surface ? bsdf_value(s.bsdf, -before, after) : vec3(phase_eval(s.medium, before, after));
}

// With which scatter_direction draws, and which weighs ways to find light against each other.
float scatter_pdf(Scatterer s, vec3 before, vec3 after) {
    return s.is_surface ? bsdf_pdf(s.bsdf, -before, after) : phase_eval(s.medium, before, after);
}

vec3 scatter_direction(Scatterer s, vec3 before, vec2 u) {
    vec3 after;
    if (s.is_surface)
        after = bsdf_guess(s.bsdf, -before, u);
    else
        after = phase_sample(s.medium, before, u);
    return after;
}

// What scatter_value and weights take as a factor where light goes the other way, from `before` to `after`, as with particles.
float adjoint(Scatterer s, vec3 before, vec3 after) {
    return s.is_surface ? bsdf_adjoint(s.bsdf, -before, after) : 1.0;
}

// A particle's vertex as it is where it is shown along `after`.
Scatterer as_shown_along(Scatterer s, vec3 after) {
    if (HAS_SMOOTH_FACES && s.is_surface)
        s.bsdf = as_seen_along(s.bsdf, after);
    return s;
}

// The most that scatter_pdf may be, roughly: of a medium toward a lamp, of a surface at all. Glass refracts into fewer directions than
// metal mirrors into, the nearer its index is to 1.
float scatter_peak(Scatterer s, vec3 travel, vec3 toward, float sine) {
    float index = max(s.bsdf.eta.x, 1.0 / max(s.bsdf.eta.x, 1.0e-6)), slower = max(index - 1.0, 1.0e-3);
    float narrower = is_glass(s.bsdf.material) ? max(1.0, 4.0 * index * index / (slower * slower)) : 1.0;
    float facets = 0.25 / (PI * s.bsdf.alpha * s.bsdf.alpha) * narrower;
    return !s.is_surface ? phase_peak(s.medium, travel, toward, sine) : has_facets(s.bsdf) ? facets : 1.0 / PI;
}
#else
#define Scatterer MediumParams
#define matter_of(v) (v)
#define is_surface(s) false
#define lit_side(s) vec3(0.0)
#define scatter_value phase_eval
#define scatter_pdf phase_eval
#define scatter_direction phase_sample
#define lit_position(s, position, to_light) (position)
#define adjoint(s, before, after) 1.0
#define as_shown_along(s, after) (s)
#define scatter_peak phase_peak
#endif

#endif
