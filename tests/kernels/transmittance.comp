// Estimates of the transmittance along rays, push.sample_end of each, by the estimator that SPEC_TRANSMITTANCE names.
// Rays are in render space. The first flight's number is drawn too.
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
    RayInput ray = inputs[i / push.sample_end];
    Rng rng = Rng(ray.key, i % push.sample_end, 0u, frame.seed);
    Spectrum T = to_spectrum(vec3(1.0));
    Walk w;
    PartSearch search;
    search.stage = SEARCH_OVER;
    uint event = EVENT_MOVING;
    if (SHADOW_RAYS_WALK) {
        uvec4 words = next_words(rng);
        w.tau = to_exponential(words.x, words);
        begin_transmittance(words, w);
        begin_segment(v, ray.origin, ray.direction, FAR, true, w, search);
    } else {
        T = transmittance_to(v, ray.origin, ray.direction, FAR);
        event = EVENT_LEFT;
    }
    bool opaque = false;
    uint steps = 0u;
    for (; steps < push.step_limit && event == EVENT_MOVING; ++steps) {
        if (is_searching(search)) {
            event = search_part(v, ray.origin, ray.direction, FAR, true, w, search);
            continue;
        }
        Collision c = no_collision(v);
        if (NULL_TRANSMITTANCE)
            event = next_collision(v, true, to_spectrum(vec3(1.0)), w, rng, tally, c);
        event = see(v, c, event, w, rng, T, opaque, tally);
        event = opaque ? EVENT_LEFT : after_step(event, w, FAR, search);
    }
    if (SHADOW_RAYS_WALK)
        T = opaque ? to_spectrum(vec3(0.0)) : end_transmittance(v, w, T);
    outputs[i] = FlightOutput(event, 0.0, vec3(T), tally.null_collisions, tally.lookups, steps);
    add_tally(tally);
}
