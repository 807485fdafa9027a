// Weighted delta tracking (Galtier et al. 2013): unbiased with any sigma_maj > 0. Real with probability P = sigma_t /
// (sigma_t + |sigma_n|), sigma_n = sigma_maj - sigma_t, and weighted by what that differs from sigma_t / sigma_maj. Where
// sigma_maj bounds sigma_t all weights are 1; where it does not, null collisions change the throughput's sign.
uint weighted_flight(Collision c, inout Spectrum beta) {
    float sigma_n = c.sigma_maj - c.sigma_t;
    float sum = c.sigma_t + abs(sigma_n);
    bool real = c.u * sum < c.sigma_t;
    beta *= sum / c.sigma_maj * (real ? 1.0 : sign(sigma_n));
    return real ? EVENT_COLLIDED : EVENT_TOUCHED;
}
