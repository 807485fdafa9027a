// Ratio tracking (Novak et al. 2014): T is the product of 1 - sigma_t / sigma_maj over tentative collisions.
// Unbiased even where the majorant is violated; T is then negative at times. 1 - sigma_t / sigma_maj would be rounded alike at
// each of them where that is small, and over many it would add up.
Spectrum ratio_transmittance(Collision c, Spectrum T) {
    return T - T * (c.sigma_t / c.sigma_maj * c.ratio);
}
