// Two jittered marches D_1, D_2 over the same steps, combined by the jackknife (Quenouille 1956; for transmittance Peters,
// "Jackknife Transmittance and MIS Weight Estimation", 2025): 2 exp(-mean) - (exp(-D_1) + exp(-D_2)) / 2. What the
// variance of one march adds to exp(-D) is taken away; of the bias only terms of higher order are left. May be above 1.
uint jackknife_transmittance(MediumParams v, inout Walk w, inout Rng rng, inout Tally tally) {
    if (march_is_over(w))
        return EVENT_LEFT;
    uvec4 words = next_words(rng);
    vec2 offset = float(w.index) + to_uniform(words).xy;
    float first = march_density(v, offset.x * w.dt, to_tap(words), to_choice(words), w, tally);
    float second = march_density(v, offset.y * w.dt, to_tap(words), to_choice(words), w, tally);
    w.depth += 0.5 * w.dt * (first + second);
    w.partial += w.dt * first;
    w.index += 1u;
    w.t = float(w.index) * w.dt;
    return EVENT_MOVING;
}

Spectrum end_jackknife(MediumParams v, Walk w) {
    Spectrum first = analytic_transmittance(v, w.partial);
    Spectrum second = analytic_transmittance(v, 2.0 * w.depth - w.partial);
    return 2.0 * analytic_transmittance(v, w.depth) - 0.5 * (first + second);
}
