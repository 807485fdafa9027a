// Homogeneous: the next collision is -log(1 - u) / sigma_t away.
uint analytic_flight(MediumParams v, inout Walk w, inout Spectrum beta, out Spectrum deposit) {
    deposit = to_spectrum(vec3(0.0));
    if (w.t >= w.t_end)
        return EVENT_LEFT;
    float rest = w.t_end - w.t;
    uint event = march_step(v, 1.0, rest, w, beta, deposit); // exact, since the density is constant
    w.t = event == EVENT_COLLIDED ? w.t : w.t_end;
    return event == EVENT_MOVING ? EVENT_LEFT : event;
}
