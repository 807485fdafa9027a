// One free flight per ray, by the estimator that SPEC_FREE_FLIGHT names. Rays are in render space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "shapes/segment.glsl"
TEST_IO(RayInput, FlightOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    MediumParams v = frame.media[0];
    Tally tally = NOTHING_SEEN;
    Rng rng = Rng(inputs[i].key, 0u, 0u, frame.seed);
    Spectrum beta = to_spectrum(inputs[i].beta);
    Spectrum deposit;
    Walk w;
    PartSearch search;
    w.tau = begin_flight(v, beta, inputs[i].e, inputs[i].select);
    w.depth = 0.0;
    w.least = SPLITS ? LEAST_IN_CELL : 0.0;
    Split split;
    split.collided = 0.0;
    begin_segment(v, inputs[i].origin, inputs[i].direction, FAR, false, w, search);
    uint event = EVENT_MOVING;
    uint steps = 0u;
    for (; steps < push.step_limit && (event == EVENT_MOVING || event == EVENT_TOUCHED); ++steps) {
        if (is_searching(search)) {
            event = search_part(v, inputs[i].origin, inputs[i].direction, FAR, false, w, search);
            continue;
        }
        Collision c = no_collision(v);
        event = NULL_FLIGHT ? next_collision(v, false, beta, w, rng, tally, c) : EVENT_MOVING;
        event = fly(v, c, event, w, rng, beta, split, deposit, tally);
        event = after_step(event, w, FAR, search);
    }
    if (event == EVENT_LEFT && !NULL_FLIGHT && !goes_through())
        beta *= depth_weight(v, beta, w.depth, false);
    outputs[i] = FlightOutput(event, w.start + w.t, vec3(beta), tally.null_collisions, tally.lookups, steps);
    add_tally(tally);
}
