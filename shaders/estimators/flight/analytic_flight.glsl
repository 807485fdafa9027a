// Homogeneous: the next collision is -log(1 - u) / sigma_t away. Where the density falls exponentially with height, the depth is
// a closed form as well. A flight that is split goes through, and leaves the light that collides where it has collided.
uint analytic_flight(MediumParams v, inout Walk w, inout Spectrum beta, inout Split split, out Spectrum deposit) {
    deposit = to_spectrum(vec3(0.0));
    if (w.t >= w.t_end)
        return EVENT_LEFT;
    float from = w.t, rest = w.t_end - from;
    float mean = 1.0, tau = w.tau;
    Fading fading = Fading(0.0, 0.0);
    if (LAYERED) {
        fading = fading_along(v, w.origin, w.direction);
        mean = faded_depth(fading, rest) / rest;
    }
    bool splits = SPLITS && w.least > 0.0;
    float depth = v.sigma_t * mean * rest;
    if (SPLITS)
        if (splits) { // the flight's depth is drawn among those that collide
            tau = split_depth(depth, tau);
            split_at_once(depth, w, beta, split);
            w.tau = FAR;
        }
    uint event = march_step(v, mean, rest, w, beta, deposit); // exact, since that is the whole depth
    if (LAYERED)
        w.t = min(faded_distance(fading, tau / v.sigma_t), w.t_end);
    if (SPLITS)
        if (splits)
            split.at = w.start + (LAYERED ? w.t : mix(from, w.t_end, depth > 0.0 ? tau / depth : 0.0));
    w.t = event == EVENT_COLLIDED ? w.t : w.t_end;
    if (LAYERED)
        w.at = w.t;
    return event == EVENT_MOVING ? EVENT_LEFT : event;
}
