// Tentative collisions: the walk, the density where it stops, and the random numbers that decide what happens there.
#ifndef COLLISION_GLSL
#define COLLISION_GLSL
#include "field/superposition.glsl"
#include "majorants/majorant.glsl"
#include "lib/rng.glsl"
#include "lib/tally.glsl"

struct Collision {
    float sigma_t;   // filtered as the scene asks; with one stochastic tap only its expectation is the field's. Of the
                     // channel in which it is largest
    float sigma_maj; // > 0 at a collision: the rate of tentative ones
    float u;         // [0, 1), for the estimator
    float sigma_c;   // of the control density
    float flown;     // in the cell, since the last step
    Spectrum ratio;  // of the channels to sigma_t
    Spectrum share;  // what of the throughput it is with the medium that was drawn: see superposition.glsl
};

Collision no_collision(MediumParams v) {
    return Collision(0.0, 1.0, 0.0, 0.0, 0.0, to_spectrum(v.sigma_ratio), to_spectrum(vec3(1.0)));
}

// One step of the walk. EVENT_COLLIDED: a tentative collision, described in `c`; the distance to the next one is drawn.
// `seeing`: the walk is a shadow ray's. `beta`: the throughput that collides.
uint next_collision(MediumParams v, bool seeing, Spectrum beta, inout Walk w, inout Rng rng, inout Tally tally, out Collision c) {
    bool residual = CONTROLLED_TRANSMITTANCE && seeing;
    c.sigma_c = v.sigma_t * w.control;
    c.ratio = to_spectrum(v.sigma_ratio);
    c.share = to_spectrum(vec3(1.0));
    float from = w.t;
    uint event = advance(v, residual, w);
    c.sigma_maj = w.rate;
    c.flown = w.t - from;
    w.at = w.t;
    if (event != EVENT_COLLIDED) {
        tally.cells += 1u;
        return event;
    }
    uvec4 words = next_words(rng);
    w.tau = to_exponential(words.x, words);
    c.u = to_event(words);
    c.sigma_t = c.sigma_maj;
    // Below the control density a collision is real, whatever the density.
    bool certain = CONTROLLED_FLIGHT && !seeing && c.u * c.sigma_maj < c.sigma_c;
    if (!certain) {
        Matter met = matter_in(v, w.cell_row, w.origin + w.t * w.direction, to_tap(words), to_choice(words), beta);
        c.sigma_t = v.sigma_t * met.density;
        c.ratio = met.ratio;
        c.share = met.share;
        w.met = met.medium;
        w.tap = to_tap(words);
        tally.lookups += 1u;
        float above = residual ? abs(c.sigma_t - c.sigma_c) : c.sigma_t;
        tally.violations += above > 1.00001 * c.sigma_maj ? 1u : 0u;
    }
    return event;
}

#endif
