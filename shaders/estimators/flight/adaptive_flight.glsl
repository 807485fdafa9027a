// Ray marching with steps of equal majorant optical depth: short where it may be dense, one step across a cell that is
// empty. Biased, see march.glsl.
uint adaptive_flight(MediumParams v, inout Walk w, inout Rng rng, inout Spectrum beta, out Spectrum deposit,
                     inout Tally tally) {
    deposit = to_spectrum(vec3(0.0));
    if (w.t >= w.t_end)
        return EVENT_LEFT;
    vec3 t_face;
    float t_exit = cell_exit(v, w, t_face);
    if (w.sigma_maj <= 0.0) {
        tally.cells += 1u;
        return next_cell(v, false, t_exit, t_face, w);
    }
    float longest = frame.march.optical_step / w.sigma_maj;
    bool to_face = w.t + longest >= t_exit;
    float dt = to_face ? t_exit - w.t : longest;
    uvec4 words = next_words(rng);
    vec4 u = to_uniform(words);
    float offset = frame.march.jitter != 0.0 ? u.x : 0.5;
    float rho = march_density(v, w.t + offset * dt, to_tap(words), to_choice(words), w, tally);
    uint event = march_step(v, rho, dt, w, beta, deposit);
    beta = march_roulette(u.y, beta);
    if (event == EVENT_COLLIDED)
        return event;
    w.t += dt;
    if (!to_face)
        return event;
    if (next_cell(v, false, t_exit, t_face, w) == EVENT_LEFT)
        w.t = w.t_end;
    return event;
}
