// A segment goes on: steps of a flight or a shadow ray, until something happens or it is time for another look.
#ifndef STAGE_TRACK_GLSL
#define STAGE_TRACK_GLSL
#include "estimators/ahead.glsl"
#include "stages/glow.glsl"
#include "stages/lane.glsl"
#include "stages/show.glsl"

// Emission along what was just flown, by one sample: a track-length estimate.
void add_glow_along(MediumParams v, Spectrum beta, float from, inout Lane lane, inout Rng rng, inout Tally tally) {
    uvec4 words = next_words(rng);
    Walk w = lane.walk;
    float t = mix(from, w.t, to_uniform(words).x);
    tally.lookups += 1u;
    vec3 p = w.origin + t * w.direction, position = lane.path.position + (w.start + t) * lane.path.direction;
#ifdef SEVERAL
    add_glow_of_all(v, vec3(beta * (w.t - from)), p, to_tap(words), position, w.start + t, lane);
#else
    Matter met = matter_at(v, p, to_tap(words), 0.0, beta);
    beta *= (w.t - from) * share_at(v, position, w.start + t, lane);
    add_light(lane, beta * (v.sigma_t * met.density) * met.ratio * emitted_radiance(v, position),
              glow_label(lane.path.depth) | label_at(lane, v));
#endif
}

// Whether what a flight gathers of an even glow is a closed form: all that it may fly through, wherever it ends.
const bool GLOWS_EVENLY = (int((FLIGHT_TRAITS & TRAIT_CLOSED) != 0) & int(EMISSION == EMISSION_CONSTANT) & int(ALBEDO == ALBEDO_CONSTANT) &
                           int(MAP == MAP_NONE)) != 0;

// Of a part of a flight that has come to it with throughput `beta`, having passed the density integral `depth`.
void add_glow_of_part(MediumParams v, Spectrum beta, float depth, inout Lane lane) {
    Walk w = lane.walk;
    float whole = w.t_end;
    if (LAYERED)
        whole = faded_depth(fading_along(v, w.origin, w.direction), w.t_end);
    Spectrum met = beta * depth_weight(v, beta, depth, false) * one_minus_exp(v.sigma_t * to_spectrum(v.sigma_ratio) * whole);
    met *= share_at(v, lane.path.position, 0.0, lane);
    add_light(lane, met * emitted_radiance(v, lane.path.position), glow_label(lane.path.depth) | label_at(lane, v));
}

// One step of the lane's segment, flight or shadow ray.
uint step_segment(MediumParams v, inout Lane lane, inout Rng rng, out Spectrum deposit, inout Tally tally) {
    bool seeing = at_shadow_ray(lane.todo == TODO_SEE);
    uint event = EVENT_MOVING;
    deposit = to_spectrum(vec3(0.0));
    Collision c = no_collision(v);
    if ((NULL_FLIGHT && NULL_TRANSMITTANCE) || (seeing ? NULL_TRANSMITTANCE : NULL_FLIGHT))
        event = next_collision(v, seeing, lane.beta, lane.walk, rng, tally, c);
    if (seeing) {
        bool opaque;
        event = see(v, c, event, lane.walk, rng, lane.T, opaque, tally);
        event = opaque ? EVENT_OPAQUE : event;
    } else {
        float from = lane.walk.t - c.flown; // a walk has gone its step already
        Spectrum before = lane.beta;
        float depth = lane.walk.depth;
        event = fly(v, c, event, lane.walk, rng, lane.beta, lane.split, deposit, tally);
        bool matter = !NULL_FLIGHT || c.sigma_maj > 0.0; // else the cell is empty
        bool gathers = EMISSION != EMISSION_NONE && EMISSION_AT == EMISSION_AT_STEPS && !goes_through();
        if (gathers && matter && !is_particle(lane)) {
            if (GLOWS_EVENLY)
                add_glow_of_part(v, before, depth, lane);
            else
                add_glow_along(v, before, from, lane, rng, tally);
        }
    }
    return after_step(event, lane.walk, seeing ? looking_as_far_as(lane) : flying_as_far_as(lane), lane.search);
}

// EVENT_MOVING: nothing has happened yet. After EVENT_COLLIDED the path is where it collided. `deposit`: see
// free_flight.glsl.
uint track(MediumParams v, inout Lane lane, inout Rng rng, out Spectrum deposit, inout Tally tally) {
    deposit = to_spectrum(vec3(0.0));
    uint event = EVENT_MOVING;
    uint steps = tally.steps;
    bool seeing = at_shadow_ray(lane.todo == TODO_SEE);
    if (SHAPE == SHAPE_MESH)
        event = search_part(v, seeing ? looking_from(lane) : lane.path.position,
                            seeing ? looking_along(lane) : lane.path.direction,
                            seeing ? looking_as_far_as(lane) : flying_as_far_as(lane), seeing, lane.walk, lane.search);
    if (looks_ahead()) {
        event = step_ahead(v, seeing, lane.walk, rng, lane.beta, lane.T, lane.split, tally);
    } else {
        for (int k = 0; k < STEPS && event == EVENT_MOVING && !is_searching(lane.search); ++k) {
            event = step_segment(v, lane, rng, deposit, tally);
            tally.steps += 1u;
        }
    }
    lane.steps += tally.steps - steps;
    if (event == EVENT_MOVING && lane.steps >= push.step_limit) {
        event = EVENT_CUT;
        tally.step_caps += 1u;
    }
    if (SPLITS && event == EVENT_COLLIDED && lane.split.collided > 0.0)
        pick_again(lane.walk, lane.beta, lane.begun_with, lane.split, rng);
    if (event == EVENT_COLLIDED)
        lane.path.position += (lane.walk.start + lane.walk.t) * lane.path.direction;
    return event;
}

#endif
