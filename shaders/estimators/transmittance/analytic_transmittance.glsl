// Homogeneous: known at once. `distance` within the medium.
Spectrum analytic_transmittance(MediumParams v, float distance) {
    return exp(-(v.sigma_t * to_spectrum(v.sigma_ratio)) * distance);
}

// Where the medium has several parts, a step passes one. Of an exponential the depth is a closed form as well, and of several even media.
uint analytic_step(MediumParams v, inout Walk w) {
#ifdef SEVERAL
    w.depth += depth_of_all(v.extent * w.origin, v.extent * w.direction, w.t_end);
#else
    w.depth += LAYERED ? faded_depth(fading_along(v, w.origin, w.direction), w.t_end) : w.t_end;
#endif
    w.t = w.t_end;
    return EVENT_LEFT;
}
