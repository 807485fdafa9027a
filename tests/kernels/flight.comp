// One free flight per ray, by the estimator that SPEC_FREE_FLIGHT names. Rays are in render space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "include/free_flight.glsl"
TEST_IO(RayInput, FlightOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    VolumeParams v = frame.volume;
    Tally tally = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u);
    Ray ray = to_medium(v, inputs[i].origin, inputs[i].direction);
    Rng rng = Rng(inputs[i].key, 0u, 0u, frame.seed);
    vec2 t;
    uint event = intersect_volume(v, ray, t) ? EVENT_MOVING : EVENT_LEFT;
    Walk w = begin_walk(v, ray, event == EVENT_MOVING ? t : vec2(0.0), to_exponential(inputs[i].u));
    for (uint k = 0u; k < push.step_limit && event == EVENT_MOVING; ++k) {
        if (FREE_FLIGHT == FREE_FLIGHT_ANALYTIC) {
            event = analytic_flight(v, w);
        } else {
            Collision c;
            event = next_collision(v, w, rng, tally, c);
            if (event == EVENT_COLLIDED)
                event = resolve_flight(c, tally);
        }
    }
    outputs[i] = FlightOutput(event, t.x + w.t, 0.0, tally.null_collisions);
    add_tally(tally);
}
