// What there is at a point. Where a scene has several media their extinctions add up: then the medium that walks go through is
// the superposition of all, whose cells bound that sum and list which of them may be there, and what a path collides with
// is one of them, by its share. Hence every estimator that knows its medium by look-ups alone serves several as it serves one.
#ifndef SUPERPOSITION_GLSL
#define SUPERPOSITION_GLSL
#include "field/density.glsl"
#include "lib/rng.glsl"
#include "shapes/shape.glsl"

struct Matter {
    float density;  // in units of the medium's sigma_t
    uint medium;    // of several, the row of one, drawn by its share of the extinction
    Spectrum ratio; // of the channels' extinction to that of the largest
    Spectrum share; // of the medium in a channel's extinction, over the chance with which it was drawn
};

// Of its parts, which are to be asked for what collisions need: phase function, albedo, emission.
MediumParams medium_of(MediumParams v, uint row) {
#ifdef SEVERAL
    return media[row];
#else
    return v;
#endif
}

#ifdef SEVERAL
// Extinction of one of them at a point of render space.
float extinction_of(uint row, vec3 position, vec3 tap) {
    MediumParams m = media[row];
    vec3 p = to_medium(m, position, vec3(0.0)).origin;
    const int field = KIND(MEMBER_FIELD, m, field);
    bool in_box = all(greaterThanEqual(p, m.bounds_min)) && all(lessThanEqual(p, m.bounds_max));
    bool inside = KIND(MEMBER_SHAPE, m, shape) == SHAPE_SPHERE ? dot(p, p) < 1.0 : in_box;
    float found = 1.0;
    if (field == FIELD_NOISE)
        found = noise_density(m.noise, row, m.extent * p);
    else if (field == FIELD_GRID)
        found = lookup(m.density, KIND(GRID_TYPE, m, grid_type), p, tap);
    return inside ? m.sigma_t * found : 0.0;
}

// `u` in [0, 1), for the draw; `tap`: see density.glsl. A point of the superposition's space, which is that of render space in
// units of a cell.
Matter matter_at(MediumParams v, vec3 p, vec3 tap, float u) {
    ivec3 cell = clamp(ivec3(floor(p - v.bounds_min)), ivec3(0), v.cell_dims - 1);
    uint i = uint((cell.x * v.cell_dims.y + cell.y) * v.cell_dims.z + cell.z);
    Matter found = Matter(0.0, 0u, to_spectrum(vec3(1.0)), to_spectrum(vec3(1.0)));
    Spectrum sum = to_spectrum(vec3(0.0));
    uint end = overlaps[i + 1u];
    for (uint k = overlaps[i]; k < end; ++k) {
        uint row = overlaps[k];
        float sigma_t = extinction_of(row, v.extent * p, tap);
        found.density += sigma_t;
        float share = sigma_t > 0.0 ? sigma_t / found.density : 0.0;
        bool drawn = u < share;
        found.medium = drawn ? row : found.medium;
        u = drawn ? u / share : (u - share) / (1.0 - share); // uniform again
#ifdef CHROMATIC
        sum += sigma_t * media[row].sigma_ratio;
#endif
    }
#ifdef CHROMATIC
    found.ratio = found.density > 0.0 ? sum / found.density : found.ratio;
    vec3 own = media[found.medium].sigma_ratio;
    found.share = mix(own / found.ratio, vec3(1.0), equal(found.ratio, vec3(0.0)));
#endif
    return found;
}

float density(MediumParams v, vec3 p, vec3 tap) {
    return matter_at(v, p, tap, 0.0).density;
}
float to_choice(uvec4 words) {
    return to_uniform(pcg4d(words)).x;
}
#else
Matter matter_at(MediumParams v, vec3 p, vec3 tap, float u) {
    return Matter(density(v, p, tap), 0u, to_spectrum(v.sigma_ratio), to_spectrum(vec3(1.0)));
}
float to_choice(uvec4 words) {
    return 0.0;
}
#endif

#endif
