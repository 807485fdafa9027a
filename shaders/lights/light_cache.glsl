// Next-event estimation from a cache. With T~ a transmittance towards the light that is known beforehand, roughly, and T what
// a shadow ray estimates, a collision of contribution c per transmittance adds
//   c T~, and with chance q also c (T - T~) / q,
// whose expectation is c T whatever T~ and q are: T~ is a control variate, and q decides only how noise and time trade.
// Worth a shadow ray is a collision that contributes much and about whose T~ there is doubt: where it is neither 0 nor 1.
#ifndef LIGHT_CACHE_GLSL
#define LIGHT_CACHE_GLSL
#include "field/albedo.glsl"
#include "lights/lattice.glsl"
#include "phase/phase.glsl"
#include "shapes/shape.glsl"

// Measured: the chance of a doubtful isotropic collision is 1 with 4. Between the directions of a lattice less is known.
const float LOOKING = 4.0;
const float LOOKING_BETWEEN = 16.0;
const float LEAST_CHANCE = 0.05; // bounds the weight of what the cache has wrong
const float DOUBT_AT_ENDS = 0.02;

// T~ from a point of render space, towards the sun.
Spectrum cached_transmittance(MediumParams v, vec3 position) {
    float depth = lattice_value(LATTICE_DEPTH, to_medium(v, position, vec3(0.0)).origin);
    return exp(-to_spectrum(v.sigma_ratio) * depth);
}

const float NEAR_SUN = 0.99; // cosine: about 8 degrees

// Depth in any direction: of the sun that is there, or between those of the axis and the diagonal that are nearest.
float cached_depth(MediumParams v, vec3 position, vec3 direction, out float looking) {
    vec3 p = to_medium(v, position, vec3(0.0)).origin;
    vec3 a = abs(direction);
    float most = max(a.x, max(a.y, a.z));
    int axis = a.x == most ? 0 : a.y == most ? 1 : 2;
    uvec3 negative = uvec3(lessThan(direction, vec3(0.0)));
    uint first = 2u * uint(axis) + negative[axis];
    uint diagonal = CACHE_AXES + (negative.x | negative.y << 1u | negative.z << 2u);
    float share = clamp((1.0 - most) / (1.0 - inversesqrt(3.0)), 0.0, 1.0);
    looking = LOOKING_BETWEEN;
    [[unroll]] for (uint i = 0u; i < CACHE_SUNS; ++i) {
        bool at_sun = dot(direction, frame.cache_suns[i]) > NEAR_SUN;
        first = at_sun ? CACHE_DIRECTIONS + i : first;
        share = at_sun ? 0.0 : share;
        looking = at_sun ? LOOKING : looking;
    }
    return mix(lattice_value(LATTICE_DEPTH + first, p), lattice_value(LATTICE_DEPTH + diagonal, p), share);
}

// T~ towards a light of a table: of one that is not infinitely far, without what is behind it.
Spectrum cached_transmittance_to(MediumParams v, vec3 position, vec3 direction, float reach, out float looking) {
    float depth = cached_depth(v, position, direction, looking);
    if (reach < FAR)
        depth = max(depth - cached_depth(v, position + reach * direction, direction, looking), 0.0);
    return exp(-to_spectrum(v.sigma_ratio) * depth);
}

// q. `share`: of the light that an isotropic collision at throughput 1 would scatter into the path.
float looking_chance(float share, Spectrum T, float looking) {
    float t = largest(T);
    float doubt = sqrt(max(t * (1.0 - t), 0.0)) + DOUBT_AT_ENDS;
    return clamp(looking * share * doubt, LEAST_CHANCE, 1.0);
}

// A control variate for the direction in which a path departs: what a collision at its end would scatter towards the path, less
// what that is on average over directions, per unit of throughput and irradiance. The average is known: see
// phase_eval_twice. Hence this may be subtracted with any factor that was known before. A good one is the
// transmittance expected there, which for a flight towards the light, through an optical depth tau, is the integral of
// exp(-t) exp(-(tau - t)): tau exp(-tau). `T`: of the cache, where the path departs, at `position`; the albedo there
// stands for the one at the flight's end.
Spectrum foreseen_light(MediumParams v, vec3 position, Spectrum T, vec3 before, vec3 after) {
    Spectrum factor = -T * log(max(T, to_spectrum(vec3(1.0e-30)))) * to_spectrum(albedo_at(v, position));
    float average = phase_eval_twice(v, before, frame.lights[FRAME_DIRECTIONAL].direction);
    return factor * (phase_eval(v, after, frame.lights[FRAME_DIRECTIONAL].direction) - average);
}

#endif
