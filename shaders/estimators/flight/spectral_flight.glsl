// Spectral tracking (Kutz et al. 2017): extinction differs between channels. One flight serves all three; what happens
// at a tentative collision is chosen by the throughput's mean over them, so that weights stay bounded.
uint spectral_flight(Collision c, inout Spectrum beta) {
    Spectrum sigma_t = c.sigma_t * c.ratio;
    Spectrum sigma_n = c.sigma_maj - sigma_t;
    float real_part = total(abs(beta * sigma_t));
    float sum = real_part + total(abs(beta * sigma_n));
    bool real = c.u * sum < real_part;
    float P = (real ? real_part : sum - real_part) / max(sum, 1.0e-30);
    beta *= (real ? sigma_t : sigma_n) / (c.sigma_maj * max(P, 1.0e-30));
    return real ? EVENT_COLLIDED : EVENT_TOUCHED;
}
