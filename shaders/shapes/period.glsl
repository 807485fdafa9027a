// A domain that repeats along axes of the world: a ray that leaves it by a face goes on from the face across, any number of times.
// What is in the domain alone repeats; what juts out of it is cut off, since no ray comes there.
#ifndef PERIOD_GLSL
#define PERIOD_GLSL
#include "majorants/majorant.glsl"

// World units to the seam that a ray comes to before `reach`, and before it has left behind all there is; FAR: to none. `axis`: 1
// along the one across it.
float seam_ahead(vec3 position, vec3 direction, float reach, out ivec3 axis) {
    PeriodParams p = frame.period;
    vec3 face = p.low + p.size * vec3(greaterThan(direction, vec3(0.0)));
    bvec3 never = lessThan(min(p.size, abs(direction)), vec3(1.0e-30));
    vec3 t = mix((face - position) / mix(direction, vec3(1.0), never), vec3(FAR), never);
    axis = first_axis(t);
    float seam = max(min(t.x, min(t.y, t.z)), 0.0);
    vec2 here;
    bool meets = intersect_box(Ray(position, direction), p.range_low, p.range_high, here);
    return meets && seam < min(here.y, reach) ? seam : FAR;
}

// To the place across, from a seam `t` ahead. Positions stay within the domain: however far a ray has gone, rounding has cost them
// an ulp at each seam and no more.
vec3 beyond_seam(vec3 position, vec3 direction, float t, ivec3 axis) {
    vec3 across = frame.period.low + frame.period.size * vec3(lessThan(direction, vec3(0.0)));
    return mix(position + t * direction, across, equal(axis, ivec3(1)));
}

bool is_in_domain(vec3 position) {
    PeriodParams p = frame.period;
    bvec3 inside = lessThan(abs(position - p.low - 0.5 * p.size), 0.5 * p.size);
    return all(equal(ivec3(1), ivec3(inside) | ivec3(equal(p.size, vec3(0.0)))));
}

// Where in the domain a ray that begins anywhere first comes near anything, `before` world units on.
vec3 place_in_domain(vec3 position, vec3 direction, out float before) {
    PeriodParams p = frame.period;
    vec2 here;
    before = intersect_box(Ray(position, direction), p.range_low, p.range_high, here) ? here.x : 0.0;
    position += before * direction;
    vec3 size = mix(p.size, vec3(1.0), equal(p.size, vec3(0.0)));
    return position - p.size * floor((position - p.low) / size);
}

#endif
