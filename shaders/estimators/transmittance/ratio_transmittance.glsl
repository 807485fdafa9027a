// Ratio tracking (Novak et al. 2014): T is the product of 1 - sigma_t / sigma_maj over tentative collisions.
// Unbiased even where the majorant is violated; T is then negative at times.
Spectrum ratio_transmittance(Collision c, Spectrum T) {
    return T * (1.0 - c.sigma_t / c.sigma_maj * c.ratio);
}
