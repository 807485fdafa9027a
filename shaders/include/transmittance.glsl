// Transmittance along a segment. Estimators return T itself, never an optical depth to be exponentiated later:
// exp of a noisy estimate is biased upward (Jensen). One function per estimator, one switch.
#ifndef TRANSMITTANCE_GLSL
#define TRANSMITTANCE_GLSL
#include "collision.glsl"

const float SHADOW_ROULETTE = 0.1; // |T| below which roulette is played: 2 to 2.5 times less work in dense clouds

float analytic_transmittance(VolumeParams v, float distance) {
    return exp(-v.sigma_t * distance);
}

// Ratio tracking (Novak et al. 2014): T is the product of 1 - sigma_t / sigma_maj over tentative collisions.
// Unbiased even where the majorant is violated; T is then negative at times. Roulette keeps it so.
float ratio_tracking(Collision c, float T) {
    T *= 1.0 - c.sigma_t / c.sigma_maj;
    if (abs(T) < SHADOW_ROULETTE)
        T = c.u * SHADOW_ROULETTE < abs(T) ? sign(T) * SHADOW_ROULETTE : 0.0;
    return T;
}

// Updates T, 1 at the start, at a tentative collision. EVENT_LEFT: it is 0, no need to go on.
uint resolve_transmittance(Collision c, inout float T, inout Tally tally) {
    switch (TRANSMITTANCE) {
    case TRANSMITTANCE_RATIO:
        T = ratio_tracking(c, T);
        break;
    }
    tally.null_collisions += 1u;
    return T == 0.0 ? EVENT_LEFT : EVENT_MOVING;
}

#endif
