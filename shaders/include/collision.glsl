// Tentative collisions: the walk, the density where it stops, and the random numbers that decide what happens there.
#ifndef COLLISION_GLSL
#define COLLISION_GLSL
#include "density.glsl"
#include "majorant.glsl"
#include "rng.glsl"
#include "tally.glsl"

struct Collision {
    float sigma_t;   // filtered as the scene asks; with one stochastic tap only its expectation is the field's
    float sigma_maj; // > 0
    float u;         // [0, 1), for the estimator
};

// One step of the walk. EVENT_COLLIDED: a tentative collision, described in `c`; the distance to the next one is drawn.
uint next_collision(VolumeParams v, inout Walk w, inout Rng rng, inout Tally tally, out Collision c) {
    c.sigma_maj = w.sigma_maj;
    uint event = advance(v, w);
    if (event != EVENT_COLLIDED) {
        tally.cells += 1u;
        return event;
    }
    uvec4 words = next_words(rng);
    vec4 u = to_uniform(words);
    w.tau = to_exponential(u.x);
    c.u = u.y;
    c.sigma_t = v.sigma_t * density(v, w.origin + w.t * w.direction, to_tap(words));
    tally.violations += c.sigma_t > 1.00001 * c.sigma_maj ? 1u : 0u;
    return event;
}

#endif
