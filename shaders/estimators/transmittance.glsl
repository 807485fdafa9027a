// Transmittance along a segment. Estimators return T itself, never an optical depth to be exponentiated later by who
// knows whom: exp of a noisy estimate is biased upward (Jensen). One file per estimator, one switch.
#ifndef TRANSMITTANCE_GLSL
#define TRANSMITTANCE_GLSL
#include "majorants/collision.glsl"
#include "estimators/march.glsl"
#include "field/voxels.glsl"

#include "estimators/transmittance/analytic_transmittance.glsl"
#include "estimators/transmittance/delta_transmittance.glsl"
#include "estimators/transmittance/jackknife_transmittance.glsl"
#include "estimators/transmittance/march_transmittance.glsl"
#include "estimators/transmittance/ratio_transmittance.glsl"
#include "estimators/transmittance/regular_transmittance.glsl"
#include "estimators/transmittance/residual_transmittance.glsl"
#include "estimators/transmittance/telescoping_transmittance.glsl"

const float SHADOW_ROULETTE = 0.1; // |T| below which roulette is played: 2 to 2.5 times less work in dense clouds
const float OPAQUE = 104.0;        // exp(-104) is 0 in single precision

// Once per shadow ray; the words of its first draw.
void begin_transmittance(uvec4 words, inout Walk w) {
    w.depth = 0.0;
    w.partial = 0.0;
    if (TRANSMITTANCE == TRANSMITTANCE_TELESCOPING)
        begin_telescoping(to_uniform(words), to_tap(words).z, w);
}

// Called for each part of the ray within the medium.
void begin_transmittance_part(MediumParams v, inout Walk w) {
    if (NULL_TRANSMITTANCE)
        begin_cells(v, CONTROLLED_TRANSMITTANCE, w);
    if ((SHADOW_TRAITS & TRAIT_VOXELS) != 0)
        begin_voxels(v, w);
    if (MARCHED_TRANSMITTANCE)
        begin_march(frame.march.shadow_step, w);
    if (TRANSMITTANCE == TRANSMITTANCE_TELESCOPING)
        refine_march(w);
}

// One step of a shadow ray. Estimators with null collisions update T, 1 at the start; `event` is what the walk met, and
// `c` its tentative collision. The others know T when the segment has ended: see end_transmittance.
// `opaque`: T is 0, no need to go on.
uint see(MediumParams v, Collision c, uint event, inout Walk w, inout Rng rng, inout Spectrum T, out bool opaque,
         inout Tally tally) {
    switch (TRANSMITTANCE) {
    case TRANSMITTANCE_ANALYTIC:
        event = analytic_step(v, w);
        break;
    case TRANSMITTANCE_REGULAR:
        event = regular_transmittance(v, w, tally);
        break;
    case TRANSMITTANCE_MARCH:
        event = march_transmittance(v, w, rng, tally);
        break;
    case TRANSMITTANCE_JACKKNIFE:
        event = jackknife_transmittance(v, w, rng, tally);
        break;
    case TRANSMITTANCE_TELESCOPING:
        event = telescoping_transmittance(v, w, tally);
        break;
    case TRANSMITTANCE_RESIDUAL:
        T = residual_transmittance(c, event, T);
        break;
    }
    if (NULL_TRANSMITTANCE && event == EVENT_COLLIDED) {
        if (TRANSMITTANCE == TRANSMITTANCE_DELTA)
            T = delta_transmittance(c, T);
        if (TRANSMITTANCE == TRANSMITTANCE_RATIO)
            T = ratio_transmittance(c, T);
        float m = largest(T);
        if (m < SHADOW_ROULETTE && TRANSMITTANCE != TRANSMITTANCE_DELTA) // unbiased
            T *= c.u * SHADOW_ROULETTE < m ? SHADOW_ROULETTE / m : 0.0;
        tally.null_collisions += 1u;
        event = EVENT_MOVING;
    }
    bool adds_depth = (SHADOW_TRAITS & (TRAIT_NULL | TRAIT_SETS)) == 0;
    opaque = adds_depth ? v.sigma_t * smallest(to_spectrum(v.sigma_ratio)) * w.depth > OPAQUE : largest(T) == 0.0;
    return event;
}

// When the ray has left the medium.
Spectrum end_transmittance(MediumParams v, Walk w, Spectrum T) {
    switch (TRANSMITTANCE) {
    case TRANSMITTANCE_ANALYTIC:
    case TRANSMITTANCE_REGULAR:
    case TRANSMITTANCE_MARCH:
        return analytic_transmittance(v, w.depth);
    case TRANSMITTANCE_JACKKNIFE:
        return end_jackknife(v, w);
    case TRANSMITTANCE_TELESCOPING:
        return end_telescoping(v, w);
    default:
        return T;
    }
}

#endif
