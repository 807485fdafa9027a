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
};

Scatterer matter_of(MediumParams v) {
    Scatterer s;
    s.medium = v;
    s.is_surface = false;
    return s;
}

Scatterer surface_of(MediumParams v, Bsdf bsdf) {
    return Scatterer(v, true, bsdf);
}

// Of light, into `after`, per steradian.
vec3 scatter_value(Scatterer s, vec3 before, vec3 after) {
    return s.is_surface ? bsdf_value(s.bsdf, -before, after) : vec3(phase_eval(s.medium, before, after));
}

// With which scatter_direction draws.
float scatter_pdf(Scatterer s, vec3 before, vec3 after) {
    return s.is_surface ? bsdf_pdf(s.bsdf, -before, after) : phase_eval(s.medium, before, after);
}

vec3 scatter_direction(Scatterer s, vec3 before, vec2 u) {
    vec3 after;
    if (s.is_surface)
        after = bsdf_sample(s.bsdf, -before, vec3(u, 0.0)).direction;
    else
        after = phase_sample(s.medium, before, u);
    return after;
}

// The most that scatter_pdf may be, roughly.
float scatter_peak(Scatterer s) {
    vec3 along = vec3(0.0, 1.0, 0.0);
    float peak = max(phase_eval(s.medium, along, along), phase_eval(s.medium, along, -along));
    return s.is_surface ? 1.0 / PI : peak;
}
#else
#define Scatterer MediumParams
#define matter_of(v) (v)
#define scatter_value phase_eval
#define scatter_pdf phase_eval
#define scatter_direction phase_sample

float scatter_peak(MediumParams v) {
    vec3 along = vec3(0.0, 1.0, 0.0);
    return max(phase_eval(v, along, along), phase_eval(v, along, -along));
}
#endif

#endif
