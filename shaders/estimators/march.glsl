// Steps of a march. Where collisions are sampled, one happens when the optical depth marched reaches the sampled one;
// where the flight goes through (see goes_through), each step interacts with as much of the throughput as it takes away.
// Biased: the density is taken to be constant along a step.
#ifndef MARCH_GLSL
#define MARCH_GLSL
#include "estimators/channel.glsl"
#include "field/superposition.glsl"
#include "lib/rng.glsl"
#include "lib/tally.glsl"

const float MARCH_ROULETTE = 1.0e-3; // throughput below which a march through plays roulette: unbiased

void begin_march(float step, inout Walk w) {
    float steps = max(ceil(w.t_end / step), 1.0);
    w.dt = w.t_end / steps;
    w.index = 0u;
}

bool march_is_over(Walk w) {
    return w.t >= w.t_end - 0.5 * w.dt;
}

float march_density(MediumParams v, float t, vec3 tap, float u, inout Walk w, inout Tally tally) {
    w.at = t;
    tally.lookups += 1u;
    Matter met = matter_at(v, w.origin + t * w.direction, tap, u, to_spectrum(vec3(1.0)));
    w.met = met.medium;
    return met.density;
}

// A step of length `dt` from w.t, in which the density is taken to be `rho`.
uint march_step(MediumParams v, float rho, float dt, inout Walk w, inout Spectrum beta, out Spectrum deposit) {
    deposit = to_spectrum(vec3(0.0));
    if (goes_through()) {
        Spectrum tau = v.sigma_t * to_spectrum(v.sigma_ratio) * rho * dt;
        deposit = beta * one_minus_exp(tau);
        beta *= exp(-tau);
        return rho > 0.0 ? EVENT_TOUCHED : EVENT_MOVING;
    }
    float tau = v.sigma_t * rho * dt;
    if (w.tau < tau) {
        w.t += dt * (w.tau / tau);
        w.at = w.t;
        w.depth += w.tau / v.sigma_t;
        return EVENT_COLLIDED;
    }
    w.tau = max(w.tau - tau, 0.0); // as in majorant.glsl
    w.depth += rho * dt;
    return EVENT_MOVING;
}

// Whether what is left of a march through the medium is worth its steps. `u` in [0, 1), drawn for this.
Spectrum march_roulette(float u, Spectrum beta) {
    float m = largest(beta);
    if (!goes_through() || m >= MARCH_ROULETTE)
        return beta;
    return beta * (u * MARCH_ROULETTE < m ? MARCH_ROULETTE / m : 0.0);
}

#endif
