// Ray marching with steps of equal length, each sampled at one point. Biased, see march.glsl.
uint march_flight(MediumParams v, inout Walk w, inout Rng rng, inout Spectrum beta, out Spectrum deposit,
                  inout Tally tally) {
    deposit = to_spectrum(vec3(0.0));
    if (march_is_over(w))
        return EVENT_LEFT;
    uvec4 words = next_words(rng);
    vec4 u = to_uniform(words);
    float begin = float(w.index) * w.dt;
    float offset = frame.march.jitter != 0.0 ? u.x : 0.5;
    float rho = march_density(v, begin + offset * w.dt, to_tap(words), to_choice(words), w, tally);
    uint event = march_step(v, rho, w.dt, w, beta, deposit);
    beta = march_roulette(u.y, beta);
    if (event == EVENT_COLLIDED)
        return event;
    w.index += 1u;
    w.t = float(w.index) * w.dt;
    return event;
}
