// Homogeneous: the next collision is -log(1 - u) / sigma_t away. Where the density falls exponentially with height, the depth is
// a closed form as well.
uint analytic_flight(MediumParams v, inout Walk w, inout Spectrum beta, out Spectrum deposit) {
    deposit = to_spectrum(vec3(0.0));
    if (w.t >= w.t_end)
        return EVENT_LEFT;
    float rest = w.t_end - w.t;
    float mean = 1.0, tau = w.tau;
    Fading fading = Fading(0.0, 0.0);
    if (LAYERED) {
        fading = fading_along(v, w.origin, w.direction);
        mean = faded_depth(fading, rest) / rest;
    }
    uint event = march_step(v, mean, rest, w, beta, deposit); // exact, since that is the whole depth
    if (LAYERED)
        w.t = min(faded_distance(fading, tau / v.sigma_t), w.t_end);
    w.t = event == EVENT_COLLIDED ? w.t : w.t_end;
    if (LAYERED)
        w.at = w.t;
    return event == EVENT_MOVING ? EVENT_LEFT : event;
}
