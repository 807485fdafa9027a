// A path as a lane of the track pass holds it: how it is laid aside and taken up again, the steps of its segments, and
// what happens where it meets matter.
#ifndef LANE_GLSL
#define LANE_GLSL
#include "ahead.glsl"
#include "camera.glsl"
#include "emission.glsl"
#include "light.glsl"
#include "light_cache.glsl"
#include "segment.glsl"

// What a lane does next.
#define TODO_TAKE 0u   // take a pixel from the queue
#define TODO_DEPART 1u // from a vertex: scatter, unless it is the camera, and fly
#define TODO_LOOK 2u   // toward the light
#define TODO_FLY 3u    // go on along the flight
#define TODO_SEE 4u    // go on along the shadow ray
#define TODO_END 5u    // the path is over
#define TODO_DONE 6u   // the pixel has its samples
#define TODO_BEGIN 7u  // a path, at the camera

// A path as a lane holds it.
struct Lane {
    PathState path;
    Spectrum beta;
    Walk walk;     // the present segment's
    Walk flight;   // to come back to, from a shadow ray sent amid it
    Spectrum T;    // of the shadow ray so far
    Spectrum lit;  // throughput of what it lights,
    vec3 position; // and where that is
    uint todo;
    uint resume; // what to do after the shadow ray
    uint steps;  // of the segment
    Spectrum cached; // transmittance that the shadow ray corrects
    float chance;    // with which it was sent
};

// What the shadow ray lights, and from where. At collisions that is the path's own vertex, and need not be kept.
Spectrum lit_beta(Lane lane) {
    return NEE == NEE_TENTATIVE ? lane.lit : lane.beta;
}
vec3 looking_from(Lane lane) {
    return NEE == NEE_TENTATIVE ? lane.position : lane.path.position;
}
uint after_looking(Lane lane) {
    return NEE == NEE_TENTATIVE ? lane.resume : SCATTERING == SCATTERING_SINGLE ? TODO_END : TODO_DEPART;
}

void suspend(uint slot, Lane lane) {
    lane.path.pixel = paths[slot].pixel;
    paths[slot] = lane.path;
    betas[slot] = lane.beta;
    if (lane.path.suspended == 0u)
        return;
    suspended[slot].walk = kept(lane.walk);
    suspended[slot].todo = lane.todo;
    suspended[slot].steps = lane.steps;
    if (LOOKS)
        suspended[slot].T = vec3(lane.T);
    if (LOOKS && NEE == NEE_CACHED) {
        suspended[slot].cached = vec3(lane.cached);
        suspended[slot].chance = lane.chance;
    }
    if (LOOKS && NEE == NEE_TENTATIVE) {
        suspended[slot].flight = kept(lane.flight);
        suspended[slot].lit = vec3(lane.lit);
        suspended[slot].position = lane.position;
        suspended[slot].resume = lane.resume;
    }
}

void resume(uint slot, inout Lane lane) {
    lane.path = paths[slot];
    lane.beta = betas[slot];
    lane.todo = TODO_DEPART;
    if (lane.path.suspended == 0u)
        return;
    lane.walk = kept(suspended[slot].walk);
    lane.todo = suspended[slot].todo;
    lane.steps = suspended[slot].steps;
    if (LOOKS)
        lane.T = to_spectrum(suspended[slot].T);
    if (LOOKS && NEE == NEE_CACHED) {
        lane.cached = to_spectrum(suspended[slot].cached);
        lane.chance = suspended[slot].chance;
    }
    if (LOOKS && NEE == NEE_TENTATIVE) {
        lane.flight = kept(suspended[slot].flight);
        lane.lit = to_spectrum(suspended[slot].lit);
        lane.position = suspended[slot].position;
        lane.resume = suspended[slot].resume;
    }
}

// At the camera.
void begin_path(inout Lane lane) {
    CameraRay ray = camera_ray(lane.path.place, lane.path.sample_index);
    lane.path.position = ray.origin;
    lane.path.direction = ray.direction;
    lane.path.radiance = vec3(0.0);
    lane.path.draw = 0u;
    lane.path.depth = 0u;
    lane.beta = to_spectrum(vec3(1.0));
    lane.todo = TODO_DEPART;
}

// Russian roulette on the throughput: unbiased, survivors are raised to the threshold.
bool survives(inout Spectrum beta, float u) {
    float m = largest(beta);
    if (m >= frame.roulette_threshold)
        return true;
    bool alive = u * frame.roulette_threshold < m;
    beta *= alive ? frame.roulette_threshold / m : 0.0;
    return alive;
}

// Emission along what was just flown, by one sample: a track-length estimate.
vec3 emission_along(VolumeParams v, Spectrum beta, float from, Walk w, PathState path, inout Rng rng,
                    inout Tally tally) {
    uvec4 words = next_words(rng);
    float t = mix(from, w.t, to_uniform(words).x);
    tally.lookups += 1u;
    float sigma_t = v.sigma_t * density(v, w.origin + t * w.direction, to_tap(words));
    vec3 Le = emitted_radiance(v.emission, path.position + (w.start + t) * path.direction);
    return beta * (w.t - from) * sigma_t * to_spectrum(v.sigma_ratio) * Le;
}

// One step of the lane's segment, flight or shadow ray; the next part follows one that ends.
uint step_segment(VolumeParams v, inout Lane lane, inout Rng rng, out Spectrum deposit, inout Tally tally) {
    bool seeing = LOOKS && lane.todo == TODO_SEE;
    uint event = EVENT_MOVING;
    deposit = to_spectrum(vec3(0.0));
    Collision c = Collision(0.0, 1.0, 0.0, 0.0, 0.0);
    if ((NULL_FLIGHT && NULL_TRANSMITTANCE) || (seeing ? NULL_TRANSMITTANCE : NULL_FLIGHT))
        event = next_collision(v, seeing, lane.walk, rng, tally, c);
    if (seeing) {
        bool opaque;
        event = see(v, c, event, lane.walk, rng, lane.T, opaque, tally);
        event = opaque ? EVENT_OPAQUE : event;
    } else {
        float from = lane.walk.t - c.flown; // a walk has gone its step already
        Spectrum before = lane.beta;
        event = fly(v, c, event, lane.walk, rng, lane.beta, deposit, tally);
        bool matter = !NULL_FLIGHT || c.sigma_maj > 0.0; // else the cell is empty
        if (EMISSION != EMISSION_NONE && EMISSION_AT == EMISSION_AT_STEPS && !goes_through() && matter)
            lane.path.radiance += emission_along(v, before, from, lane.walk, lane.path, rng, tally);
    }
    if (SHAPE == SHAPE_MESH && event == EVENT_LEFT)
        event = next_part(v, seeing ? looking_from(lane) : lane.path.position,
                          seeing ? frame.light.direction : lane.path.direction, seeing, lane.walk);
    return event;
}

// Steps of the lane's segment, until something happens or it is time for another look.
uint step_lane(VolumeParams v, inout Lane lane, inout Rng rng, out Spectrum deposit, inout Tally tally) {
    deposit = to_spectrum(vec3(0.0));
    uint event = EVENT_MOVING;
    if (looks_ahead()) {
        event = step_ahead(v, LOOKS && lane.todo == TODO_SEE, lane.walk, rng, lane.beta, lane.T, tally);
    } else {
        for (int k = 0; k < STEPS && event == EVENT_MOVING; ++k) {
            event = step_segment(v, lane, rng, deposit, tally);
            tally.steps += 1u;
        }
    }
    return event;
}

// Light at a point that an interaction of throughput `lit` there scatters into the path. Known at once in a homogeneous
// medium, else the lane goes to look, or, by chance, makes do with the cache; and then does as `next` says.
void gather_light(VolumeParams v, vec3 position, Spectrum lit, uint next, inout Lane lane, inout Rng rng) {
    if (LOOKS) {
        lane.position = position;
        lane.lit = lit;
        lane.resume = next;
        lane.todo = TODO_LOOK;
        if (NEE == NEE_CACHED) {
            lane.cached = cached_transmittance(v, position);
            Spectrum scattered = lit * hg_eval(v.g, hg_from_peak(v.g, lane.path.direction, frame.light.direction));
            lane.path.radiance += scattered * lane.cached * frame.light.irradiance;
            lane.chance = looking_chance(largest(scattered) / INV_4PI, lane.cached);
            lane.todo = to_uniform(next_words(rng)).x < lane.chance ? TODO_LOOK : next;
        }
    } else {
        Spectrum T = analytic_shadow(v, position, frame.light.direction);
        lane.path.radiance += sun_contribution(v, frame.light, lane.path.direction, lit * T);
        lane.todo = next;
    }
}

// At a real collision: emission, absorption, light. Then the path departs, or ends.
void collide(VolumeParams v, Spectrum deposit, inout Lane lane, inout Rng rng, inout Tally tally) {
    lane.path.position += (lane.walk.start + lane.walk.t) * lane.path.direction;
    if (EMISSION != EMISSION_NONE && EMISSION_AT == EMISSION_AT_COLLISIONS)
        lane.path.radiance += lane.beta * emitted_radiance(v.emission, lane.path.position);
    lane.beta *= to_spectrum(v.albedo);
    bool capped = SCATTERING != SCATTERING_NONE && lane.path.depth >= frame.max_depth;
    tally.depth_caps += capped ? 1u : 0u;
    lane.path.depth += 1u;
    bool ended = capped || SCATTERING == SCATTERING_NONE || largest(lane.beta) == 0.0;
    lane.todo = ended || SCATTERING == SCATTERING_SINGLE ? TODO_END : TODO_DEPART;
    if (NEE != NEE_NONE && !ended) {
        Spectrum lit = NEE == NEE_TENTATIVE ? deposit * to_spectrum(v.albedo) : lane.beta;
        gather_light(v, lane.path.position, lit, lane.todo, lane, rng);
    }
}

// Amid a flight: a null collision, or a step of a march through.
void touch(VolumeParams v, Spectrum deposit, inout Lane lane, inout Rng rng) {
    vec3 position = lane.path.position + (lane.walk.start + lane.walk.at) * lane.path.direction;
    uint next = TODO_FLY;
    if (goes_through()) {
        if (EMISSION != EMISSION_NONE)
            lane.path.radiance += deposit * emitted_radiance(v.emission, position);
        next = largest(lane.beta) == 0.0 ? TODO_END : TODO_FLY;
    }
    lane.todo = next;
    if (NEE == NEE_TENTATIVE && lane.path.depth < frame.max_depth)
        gather_light(v, position, deposit * to_spectrum(v.albedo), next, lane, rng);
}

#endif
