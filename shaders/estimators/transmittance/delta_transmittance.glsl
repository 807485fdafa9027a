// Track-length estimator of delta tracking: 1 if the flight has no real collision, else 0. Unbiased, coarse. All
// channels see the same number.
Spectrum delta_transmittance(Collision c, Spectrum T) {
    Spectrum sigma_t = c.sigma_t * c.ratio;
    return T * step(sigma_t, Spectrum(c.u * c.sigma_maj)); // 0 where u sigma_maj < sigma_t
}
