// Ray marching. Biased: exp of a sum that is only an estimate, too high by half its variance (Jensen).
uint march_transmittance(MediumParams v, inout Walk w, inout Rng rng, inout Tally tally) {
    if (march_is_over(w))
        return EVENT_LEFT;
    uvec4 words = next_words(rng);
    float offset = frame.march.jitter != 0.0 ? to_uniform(words).x : 0.5;
    w.depth += w.dt * march_density(v, (float(w.index) + offset) * w.dt, to_tap(words), to_choice(words), w, tally);
    w.index += 1u;
    w.t = float(w.index) * w.dt;
    return EVENT_MOVING;
}
