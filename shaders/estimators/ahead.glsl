// Several steps of a walk at once. Where the next tentative collisions would be does not depend on what comes of them, as long
// as all are null: so the walk goes ahead, their densities are read together, and memory is waited for once instead of
// every time. Then they are judged in order. What lies beyond a real one is forgotten, and the random numbers drawn for it
// are drawn again: no bit of a picture depends on how far ahead it was.
#ifndef AHEAD_GLSL
#define AHEAD_GLSL
#include "shapes/segment.glsl"

// Not where each step gathers something, or may need no look-up; noise is not waited for.
bool looks_ahead() {
    bool walks = NULL_FLIGHT && !CONTROLLED_FLIGHT;
    bool shadows_walk = NULL_TRANSMITTANCE && !CONTROLLED_TRANSMITTANCE;
    bool gathers = EMISSION != EMISSION_NONE && EMISSION_AT == EMISSION_AT_STEPS;
    bool has_voxels = FIELD == FIELD_GRID && SHAPE != SHAPE_NONE;
    return has_voxels && walks && NEE != NEE_TENTATIVE && !gathers && (!SHADOW_RAYS_WALK || shadows_walk);
}

void look_up(MediumParams v, Walk w, float t[STEPS], vec3 tap[STEPS], out float sigma_t[STEPS]) {
    if (FILTER == FILTER_TRILINEAR) {
        [[unroll]] for (int k = 0; k < STEPS; ++k)
            sigma_t[k] = v.sigma_t * density(v, w.origin + t[k] * w.direction, tap[k]);
        return;
    }
    VoxelPlace place[STEPS];
    uint entry[STEPS];
    [[unroll]] for (int k = 0; k < STEPS; ++k) {
        vec3 p = w.origin + t[k] * w.direction;
        place[k] = find_voxel(v.density, FILTER == FILTER_NEAREST ? nearest_voxel(p) : random_corner(p, tap[k]));
    }
    [[unroll]] for (int k = 0; k < STEPS; ++k)
        entry[k] = leaf_entry(place[k].entry);
    [[unroll]] for (int k = 0; k < STEPS; ++k)
        sigma_t[k] = v.sigma_t * mapped(v, voxel_value(v.density, GRID_TYPE, place[k], entry[k]));
}

// Up to STEPS steps of a flight or, `seeing`, of a shadow ray of transmittance T. The walk is left at the event.
uint step_ahead(MediumParams v, bool seeing, inout Walk walk, inout Rng rng, inout Spectrum beta, inout Spectrum T,
                inout Split split, inout Tally tally) {
    uint step[STEPS]; // what the walk met
    float t[STEPS];
    float sigma_maj[STEPS];
    float u[STEPS];
    vec3 tap[STEPS];
    Walk w = walk;
    Rng ahead = rng;
    uint last = EVENT_MOVING;
    [[unroll]] for (int k = 0; k < STEPS; ++k) {
        step[k] = EVENT_LEFT;
        sigma_maj[k] = 0.0;
        if (last != EVENT_LEFT) {
            last = advance(v, false, w);
            step[k] = last;
            sigma_maj[k] = w.rate;
        }
        t[k] = w.t;
        Rng drawn = ahead;
        uvec4 words = next_words(drawn);
        u[k] = to_event(words);
        tap[k] = to_tap(words);
        if (step[k] == EVENT_COLLIDED) {
            w.tau = to_exponential(words.x, words);
            ahead = drawn;
        }
    }
    float sigma_t[STEPS];
    look_up(v, w, t, tap, sigma_t);
    uint event = EVENT_MOVING;
    [[unroll]] for (int k = 0; k < STEPS; ++k) {
        if (event == EVENT_MOVING) {
            event = step[k];
            tally.steps += 1u;
            tally.cells += event == EVENT_COLLIDED ? 0u : 1u;
            if (event == EVENT_COLLIDED) {
                Collision c = Collision(sigma_t[k], sigma_maj[k], u[k], 0.0, 0.0, to_spectrum(v.sigma_ratio), to_spectrum(vec3(1.0)));
                tally.lookups += 1u;
                tally.violations += c.sigma_t > 1.00001 * c.sigma_maj ? 1u : 0u;
                rng.draw += 1u;
                walk.t = t[k];
                if (SHADOW_RAYS_WALK && seeing) {
                    bool opaque;
                    event = see(v, c, event, walk, rng, T, opaque, tally);
                    event = opaque ? EVENT_OPAQUE : event;
                } else {
                    Spectrum deposit;
                    event = fly(v, c, event, walk, rng, beta, split, deposit, tally);
                }
            }
        }
    }
    if (event == EVENT_MOVING || event == EVENT_LEFT)
        walk = w;
    return event;
}

#endif
