// Residual ratio tracking (Novak et al. 2014): exp of a control density's optical depth, times ratio tracking of what
// the density differs from it, whose bound sigma_maj is here. The ratio may exceed 1 where the density is below control.
Spectrum residual_transmittance(Collision c, uint event, Spectrum T) {
    T *= exp(-c.sigma_c * c.flown * c.ratio);
    return event == EVENT_COLLIDED ? T * (1.0 - (c.sigma_t - c.sigma_c) / c.sigma_maj * c.ratio) : T;
}
