// A path as a lane of the track pass holds it, and how it is laid aside and taken up again.
#ifndef LANE_GLSL
#define LANE_GLSL
#include "shapes/segment.glsl"

// What a lane does next.
#define TODO_TAKE 0u   // take a pixel from the queue
#define TODO_DEPART 1u // from a vertex: scatter, unless it is the camera, and fly
#define TODO_LOOK 2u   // toward the light
#define TODO_FLY 3u    // go on along the flight
#define TODO_SEE 4u    // go on along the shadow ray
#define TODO_END 5u    // the path is over
#define TODO_DONE 6u   // the pixel has its samples
#define TODO_BEGIN 7u  // a path, at the camera

// A path as a lane holds it.
struct Lane {
    PathState path;
    Spectrum beta;
    Walk walk;     // the present segment's
    Walk flight;   // to come back to, from a shadow ray sent amid it
    Spectrum T;    // of the shadow ray so far
    Spectrum lit;  // throughput of what it lights,
    vec3 position; // and where that is
    uint todo;
    uint resume;       // what to do after the shadow ray
    uint steps;        // of the segment
    Spectrum cached;   // transmittance that the shadow ray corrects
    float chance;      // with which it was sent
    PartSearch search; // of the present segment, in a mesh
};

// What the shadow ray lights, and from where. At collisions that is the path's own vertex, and need not be kept.
Spectrum lit_beta(Lane lane) {
    return NEE == NEE_TENTATIVE ? lane.lit : lane.beta;
}
vec3 looking_from(Lane lane) {
    return NEE == NEE_TENTATIVE ? lane.position : lane.path.position;
}
uint after_looking(Lane lane) {
    return NEE == NEE_TENTATIVE ? lane.resume : SCATTERING == SCATTERING_SINGLE ? TODO_END : TODO_DEPART;
}

void lay_aside(uint slot, Rng rng, Lane lane) {
    lane.path.draw = rng.draw;
    lane.path.suspended = lane.todo == TODO_DEPART && NEE != NEE_CACHED ? 0u : 1u;
    lane.path.pixel = paths[slot].pixel;
    paths[slot] = lane.path;
    betas[slot] = lane.beta;
    if (lane.path.suspended == 0u)
        return;
    suspended[slot].walk = kept(lane.walk);
    suspended[slot].todo = lane.todo;
    suspended[slot].steps = lane.steps;
    if (SHAPE == SHAPE_MESH)
        suspended[slot].search = lane.search;
    if (LOOKS)
        suspended[slot].T = vec3(lane.T);
    if (LOOKS && NEE == NEE_CACHED) {
        suspended[slot].cached = vec3(lane.cached);
        suspended[slot].chance = lane.chance;
    }
    if (LOOKS && NEE == NEE_TENTATIVE) {
        suspended[slot].flight = kept(lane.flight);
        suspended[slot].lit = vec3(lane.lit);
        suspended[slot].position = lane.position;
        suspended[slot].resume = lane.resume;
    }
}

void take_up(uint slot, inout Lane lane) {
    lane.path = paths[slot];
    lane.beta = betas[slot];
    lane.todo = TODO_DEPART;
    if (lane.path.suspended == 0u)
        return;
    lane.walk = kept(suspended[slot].walk);
    lane.todo = suspended[slot].todo;
    lane.steps = suspended[slot].steps;
    if (SHAPE == SHAPE_MESH)
        lane.search = suspended[slot].search;
    if (LOOKS)
        lane.T = to_spectrum(suspended[slot].T);
    if (LOOKS && NEE == NEE_CACHED) {
        lane.cached = to_spectrum(suspended[slot].cached);
        lane.chance = suspended[slot].chance;
    }
    if (LOOKS && NEE == NEE_TENTATIVE) {
        lane.flight = kept(suspended[slot].flight);
        lane.lit = to_spectrum(suspended[slot].lit);
        lane.position = suspended[slot].position;
        lane.resume = suspended[slot].resume;
    }
}

#endif
