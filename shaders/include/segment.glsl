// Segments: what flights and shadow rays have in common. Both cross the medium part by part; a mesh that is not convex
// has several, and the optical depth left is carried over from one to the next.
#ifndef SEGMENT_GLSL
#define SEGMENT_GLSL
#include "free_flight.glsl"
#include "transmittance.glsl"

// Where a shadow ray is a walk of its own; a homogeneous medium's is known at once.
const bool LOOKS = NEE != NEE_NONE && TRANSMITTANCE != TRANSMITTANCE_ANALYTIC;

// What the scene's estimators need of a walk that is laid aside. The rest is dropped, so that nothing computes it.
Walk kept(Walk w) {
    bool marches = FREE_FLIGHT == FREE_FLIGHT_MARCH || (LOOKS && MARCHED_TRANSMITTANCE);
    bool adds_depth = !NULL_FLIGHT || (LOOKS && !NULL_TRANSMITTANCE);
    bool walks = NULL_FLIGHT || FREE_FLIGHT == FREE_FLIGHT_ADAPTIVE || (LOOKS && NULL_TRANSMITTANCE);
    bool voxels = FREE_FLIGHT == FREE_FLIGHT_REGULAR || (LOOKS && TRANSMITTANCE == TRANSMITTANCE_REGULAR);
    bool controlled =
        FREE_FLIGHT == FREE_FLIGHT_DECOMPOSITION || (LOOKS && TRANSMITTANCE == TRANSMITTANCE_RESIDUAL);
    bool marches_more = LOOKS && TRANSMITTANCE > TRANSMITTANCE_MARCH; // marches in several sets of samples
    w.at = 0.0; // set by every step
    if (!adds_depth)
        w.depth = 0.0;
    if (!walks)
        w.sigma_maj = 0.0;
    if (!controlled)
        w.control = 0.0;
    if (!voxels && (!walks || FIELD != FIELD_GRID))
        w.cell = ivec3(0);
    if (!marches) {
        w.dt = 0.0;
        w.index = 0u;
    }
    if (!marches_more) {
        w.level = 0u;
        w.residue = 0u;
        w.offset = 0.0;
        w.coarse = 0.0;
        w.base = 0.0;
    }
    return w;
}

// The part of the segment within the medium that begins at t.x.
void begin_part(VolumeParams v, Ray ray, vec2 t, bool seeing, inout Walk w) {
    w.origin = ray.origin + t.x * ray.direction;
    w.direction = ray.direction;
    w.start = t.x;
    w.t_end = t.y - t.x;
    w.t = 0.0;
    w.at = 0.0;
    if (LOOKS && seeing)
        begin_transmittance_part(v, w);
    else
        begin_flight_part(v, w);
}

// A vertex on the boundary, heading out, has no such part, nor a camera ray that misses: then an empty one, which the
// first step leaves.
void begin_segment(VolumeParams v, vec3 position, vec3 direction, bool seeing, inout Walk w) {
    Ray ray = to_medium(v, position, direction);
    vec2 t;
    if (!next_interval(v, ray, 0.0, t))
        t = vec2(0.0);
    begin_part(v, ray, t, seeing, w);
}

// Beyond a part that ended. A mesh may have further ones; the optical depth left is carried over.
uint next_part(VolumeParams v, vec3 position, vec3 direction, bool seeing, inout Walk w) {
    Ray ray = to_medium(v, position, direction);
    vec2 t;
    if (!next_interval(v, ray, w.start + w.t_end, t))
        return EVENT_LEFT;
    begin_part(v, ray, t, seeing, w);
    return EVENT_MOVING;
}

// Transmittance of a homogeneous medium, which may have many parts.
Spectrum analytic_shadow(VolumeParams v, vec3 position, vec3 direction) {
    Ray ray = to_medium(v, position, direction);
    float inside = 0.0;
    vec2 t = vec2(0.0);
    const int most_parts = 256;
    int part = 0;
    for (; part < most_parts && next_interval(v, ray, t.y, t); ++part)
        inside += t.y - t.x;
    if (part == most_parts) // the light may be too bright, and it is counted
        atomicAdd(counters.step_caps, 1u);
    return analytic_transmittance(v, inside);
}

#endif
