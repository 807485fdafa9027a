// Estimates of the transmittance along rays, push.sample_end of each, by the estimator that SPEC_TRANSMITTANCE names.
// Rays are in render space. The first flight's number is drawn too.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "include/transmittance.glsl"
TEST_IO(RayInput, FlightOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    VolumeParams v = frame.volume;
    Tally tally = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u);
    RayInput input_ = inputs[i / push.sample_end];
    Ray ray = to_medium(v, input_.origin, input_.direction);
    Rng rng = Rng(input_.key, i % push.sample_end, 0u, frame.seed);
    vec2 t;
    uint event = intersect_volume(v, ray, t) ? EVENT_MOVING : EVENT_LEFT;
    t = event == EVENT_MOVING ? t : vec2(0.0);
    Walk w = begin_walk(v, ray, t, to_exponential(to_uniform(next_words(rng)).x));
    float T = 1.0;
    if (TRANSMITTANCE == TRANSMITTANCE_ANALYTIC) {
        T = analytic_transmittance(v, t.y - t.x);
        event = EVENT_LEFT;
    }
    for (uint k = 0u; k < push.step_limit && event == EVENT_MOVING; ++k) {
        Collision c;
        event = next_collision(v, w, rng, tally, c);
        if (event == EVENT_COLLIDED)
            event = resolve_transmittance(c, T, tally);
    }
    outputs[i] = FlightOutput(event, t.x + w.t, T, tally.null_collisions);
    add_tally(tally);
}
