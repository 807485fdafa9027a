// Free flights: where along the segment the next real collision is. One function per estimator, one switch.
#ifndef FREE_FLIGHT_GLSL
#define FREE_FLIGHT_GLSL
#include "collision.glsl"

// Homogeneous: t = -log(1 - u) / sigma_t.
uint analytic_flight(VolumeParams v, inout Walk w) {
    w.t = w.tau / v.sigma_t;
    return w.t < w.t_end ? EVENT_COLLIDED : EVENT_LEFT;
}

// Delta tracking (Woodcock et al. 1965): a tentative collision is real with probability sigma_t / sigma_maj.
// Unbiased as long as sigma_maj bounds sigma_t; where it does not, the excess is lost: biased, and counted.
uint delta_tracking(Collision c) {
    return c.u * c.sigma_maj < c.sigma_t ? EVENT_COLLIDED : EVENT_MOVING;
}

// What a tentative collision is to a free flight: real (EVENT_COLLIDED) or null (EVENT_MOVING).
uint resolve_flight(Collision c, inout Tally tally) {
    uint event = EVENT_MOVING;
    switch (FREE_FLIGHT) {
    case FREE_FLIGHT_DELTA:
        event = delta_tracking(c);
        break;
    }
    tally.real_collisions += event == EVENT_COLLIDED ? 1u : 0u;
    tally.null_collisions += event == EVENT_COLLIDED ? 0u : 1u;
    return event;
}

#endif
