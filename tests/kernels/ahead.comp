// One segment per ray, in render space: a flight, or with push.sample_end a shadow ray. With push.sample_begin steps
// are found several ahead and looked up together, else one after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "estimators/ahead.glsl"
TEST_IO(RayInput, AheadOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    MediumParams v = frame.media[0];
    bool ahead = push.sample_begin != 0u;
    bool seeing = push.sample_end != 0u;
    RayInput ray = inputs[i];
    Tally tally = NOTHING_SEEN;
    Rng rng = Rng(ray.key, 0u, 0u, frame.seed);
    Spectrum beta = to_spectrum(ray.beta);
    Spectrum T = to_spectrum(vec3(1.0));
    Spectrum deposit;
    Walk w;
    w.tau = ray.e;
    w.depth = 0.0;
    w.least = SPLITS && !seeing ? LEAST_IN_CELL : 0.0;
    Split split;
    split.collided = 0.0;
    PartSearch search;
    begin_segment(v, ray.origin, ray.direction, FAR, seeing, w, search);
    uint event = EVENT_MOVING;
    for (uint turn = 0u; turn < push.step_limit && event == EVENT_MOVING; ++turn) {
        if (ahead) {
            event = step_ahead(v, seeing, w, rng, beta, T, split, tally);
        } else {
            Collision c = no_collision(v);
            event = next_collision(v, seeing, beta, w, rng, tally, c);
            tally.steps += 1u;
            if (seeing) {
                bool opaque;
                event = see(v, c, event, w, rng, T, opaque, tally);
                event = opaque ? EVENT_OPAQUE : event;
            } else {
                event = fly(v, c, event, w, rng, beta, split, deposit, tally);
            }
        }
    }
    vec3 found = SPLITS && !seeing ? vec3(split.collided, split.collided > 0.0 ? split.at : 0.0, 0.0) : vec3(T);
    outputs[i] = AheadOutput(event, w.t, vec3(beta), found, rng.draw, tally.lookups, tally.cells, tally.steps,
                             tally.null_collisions, tally.violations);
}
