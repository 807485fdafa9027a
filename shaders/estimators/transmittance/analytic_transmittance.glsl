// Homogeneous: known at once. `distance` within the medium.
Spectrum analytic_transmittance(MediumParams v, float distance) {
    return exp(-v.sigma_t * distance * to_spectrum(v.sigma_ratio));
}

// Where the medium has several parts, a step passes one.
uint analytic_step(inout Walk w) {
    w.depth += w.t_end;
    w.t = w.t_end;
    return EVENT_LEFT;
}
