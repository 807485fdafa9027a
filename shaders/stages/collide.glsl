// A flight meets matter.
#ifndef STAGE_COLLIDE_GLSL
#define STAGE_COLLIDE_GLSL
#include "stages/glow.glsl"
#include "lights/directional.glsl"
#include "lights/equiangular.glsl"
#include "lights/light_cache.glsl"
#include "lights/table.glsl"
#include "lib/trace.glsl"
#include "stages/count.glsl"

// Shows the sensor what a particle scatters toward it.
void show_to_sensor(MediumParams v, Scatterer s, vec3 position, Spectrum lit, uint next, inout Lane lane, inout Rng rng) {
    SensorLook look = toward_sensor(position, rng);
    s = as_shown_along(s, look.direction);
    vec3 value = vec3(scatter_value(s, lane.path.direction, look.direction)) *
                 adjoint(s, lane.path.direction, look.direction);
    vec3 lit_at = lit_position(s, position, look.direction);
    float share = WEIGHS && look.pixel != NO_PIXEL ? share_of_shown(s, look, lit_at, between(is_surface(s), value.x), lane) : 0.0;
    show(v, look, lit_at, value, share, lit, next, lane);
}

// Likewise from one of many lights, which is drawn here.
void gather_some_light(MediumParams v, Scatterer s, vec3 position, float t, Spectrum lit, uint label, uint next,
                       inout Lane lane, inout Rng rng) {
    LightRow row;
    LightSample drawn = look_for_light(s, position, lane.path.direction, rng, row);
    float pdf = scatter_pdf(s, lane.path.direction, drawn.direction);
    label |= group_label(row.group);
    vec3 light = drawn.light * scatter_value(s, lane.path.direction, drawn.direction) *
                 (drawn.pdf > 0.0 ? weight_of_look(drawn.pdf, pdf) : 1.0);
#ifdef SURFACES
    // Nothing comes through a face from what lies in it, as lamps that are of rough glass themselves.
    float beyond = s.is_surface ? -dot(s.bsdf.face, drawn.direction) : 0.0;
    if (beyond > 0.0 && drawn.distance * beyond <= reach_of_face(row) * s.apart)
        light = vec3(0.0);
#endif
    if (WEIGHS)
        light *= weight_of_looked_for(lane, shares_of_found(row, position, drawn.direction, drawn.distance, 0.0),
                                      facing(s, drawn.direction), between(is_surface(s), pdf));
    if (LOOKS_ALONG && !is_surface(s))
        light *= weight_of_collision(v, row, lane.path.direction, position, t, flying_as_far_as(lane));
    if (SHADOW_RAYS_WALK) {
        lane.position = lit_position(s, position, drawn.direction);
        lane.lit = lit;
        lane.resume = next;
        lane.leg = LEG_LOOK;
#ifdef SURFACES
        lane.lit_surface = s.is_surface ? surface_at(lane.path) : NO_SURFACE;
        lane.lamp_body = row.body;
#endif
        lane.to_light = drawn.direction;
        lane.light_distance = drawn.distance;
        lane.light = light;
        lane.label = label;
        lane.todo = largest(lit * light) > 0.0 ? TODO_LOOK : next;
        if (NEE == NEE_CACHED) {
            float looking;
            lane.cached = cached_transmittance_to(v, position, drawn.direction, drawn.distance, looking);
            add_light(lane, lit * lane.cached * light, label);
            lane.chance = looking_chance(largest(lit * light) / (INV_4PI * frame.fluence * begun_with(lane)), lane.cached, looking);
            lane.todo = to_uniform(next_words(rng)).x < lane.chance ? lane.todo : next;
        }
    } else {
        add_light(lane, lit * transmittance_to(v, position, drawn.direction, drawn.distance) * light, label);
        lane.todo = next;
    }
}

// Light at a point, t along a flight, that an interaction of throughput `lit` with `met` scatters into the path. Known at once in a homogeneous
// sphere or box, else the lane goes to look, or, by chance, makes do with the cache; and then does as `next` says. `label`: of that
// light, without its group.
void gather_light(MediumParams v, MediumParams met, vec3 position, float t, Spectrum lit, uint label, uint next, inout Lane lane,
                  inout Rng rng) {
    uint sun_label = label | group_label(frame.lights[FRAME_DIRECTIONAL].group);
    if (is_particle(lane)) {
        show_to_sensor(v, matter_of(met), position, lit, next, lane, rng);
    } else if (LIGHTS != LIGHTS_LONE) {
        gather_some_light(v, matter_of(met), position, t, lit, label, next, lane, rng);
    } else if (SHADOW_RAYS_WALK) {
        lane.label = sun_label;
        lane.position = position;
        lane.lit = lit;
        lane.lit_medium = lane.walk.met;
        lane.resume = next;
        lane.todo = TODO_LOOK;
        if (NEE == NEE_CACHED) {
            lane.cached = cached_transmittance(v, position);
            Spectrum scattered = lit * phase_eval(met, lane.path.direction, frame.lights[FRAME_DIRECTIONAL].direction);
            add_light(lane, scattered * lane.cached * frame.lights[FRAME_DIRECTIONAL].radiance, sun_label);
            lane.chance = looking_chance(largest(scattered) / (INV_4PI * begun_with(lane)), lane.cached, LOOKING);
            lane.todo = to_uniform(next_words(rng)).x < lane.chance ? TODO_LOOK : next;
        }
    } else {
        Spectrum T = transmittance_to(v, position, frame.lights[FRAME_DIRECTIONAL].direction, FAR);
        add_light(lane, directional_contribution(met, frame.lights[FRAME_DIRECTIONAL], lane.path.direction, lit * T), sun_label);
        lane.todo = next;
    }
}

// Light that comes of a collision, or absorption at it, of throughput lane.beta. Marches collide where they have looked nothing up: of
// several media theirs is that of the one that was drawn.
void add_glow(MediumParams v, MediumParams met, inout Lane lane) {
    float flown = lane.walk.start + lane.walk.t;
    if (SEVERAL_MEDIA && NULL_FLIGHT)
        add_glow_of_all(v, lane.walk.per_extinction, lane.walk.origin + lane.walk.t * lane.walk.direction, lane.walk.tap,
                        lane.path.position, flown, lane);
    else
        add_light(lane, lane.beta * share_at(met, lane.path.position, flown, lane) * emitted_radiance(met, lane.path.position),
                  glow_label(lane.path.depth) | lane.first_label);
}
vec3 absorbed_here(MediumParams v, MediumParams met, Lane lane) {
    if (SEVERAL_MEDIA && NULL_FLIGHT)
        return absorbed_by_all(v, lane.walk.per_extinction, lane.walk.origin + lane.walk.t * lane.walk.direction, lane.walk.tap,
                               lane.path.position);
    return vec3(lane.beta) * absorbed_at(met, lane.path.position);
}

// At a real collision: emission, absorption, light. Then the path departs, or ends.
void collide(MediumParams v, Spectrum deposit, inout Lane lane, inout Rng rng, inout Tally tally) {
    lane.path.medium = lane.walk.met;
    MediumParams met = medium_of(v, lane.walk.met);
    lane.first_label = label_at(lane, met);
    if (EMISSION != EMISSION_NONE && EMISSION_AT == EMISSION_AT_COLLISIONS && !is_particle(lane))
        add_glow(v, met, lane);
    vec3 albedo = albedo_at(met, lane.path.position);
    if (WEIGHS)
        note_shares(lane.path.position, lane.walk.start + lane.walk.t, 1.0, lane);
    if (HAS_LAYERS)
        if (lane.path.depth == 0u)
            note_collision(lane.record, vec3(lane.beta), lane.path.position, lane.path.direction,
                           flown_before(lane) + lane.walk.start + lane.walk.t, albedo);
    if (COUNTS_ABSORBED)
        if (is_particle(lane))
            count_absorbed(lane.path.position, absorbed_here(v, met, lane), lane);
    lane.beta *= to_spectrum(albedo);
    bool capped = SCATTERING != SCATTERING_NONE && lane.path.depth >= frame.max_depth;
    tally.depth_caps += capped ? 1u : 0u;
    lane.path.depth += 1u;
    bool ended = capped || SCATTERING == SCATTERING_NONE || largest(lane.beta) == 0.0;
    lane.todo = ended || SCATTERING == SCATTERING_SINGLE ? TODO_END : TODO_DEPART;
    if (NEE != NEE_NONE && !ended) {
        Spectrum lit = NEE == NEE_TENTATIVE ? deposit * to_spectrum(albedo) : lane.beta;
        gather_light(v, met, lane.path.position, lane.walk.start + lane.walk.t, lit,
                     kind_label(lane.path.depth) | lane.first_label, lane.todo, lane, rng);
    }
    trace(TRACE_COLLISION, lane, lane.path.position, lane.path.direction);
}

// How far behind its beginning a flight that goes through at once collides, of the channels by what each takes away: on average, or,
// where the density falls with height, of a collision that is drawn. Nothing else is drawn with these numbers while it goes through.
float collision_along(MediumParams v, Walk w, vec3 deposit, Rng rng) {
    vec3 sigma = max(v.sigma_t * v.sigma_ratio, vec3(1.0e-30));
    vec3 t;
    if (LAYERED) {
        Fading f = fading_along(v, w.origin, w.direction);
        float whole = faded_depth(f, w.t_end), u = to_uniform(next_words(rng)).x;
        [[unroll]] for (int c = 0; c < 3; ++c) {
            float depth = minus_log_of_rest(u * one_minus_exp(sigma[c] * whole)) / sigma[c];
            t[c] = min(faded_distance(f, min(depth, 0.999999 * whole)), w.t_end); // not behind the last of it, by rounding
        }
    } else {
        [[unroll]] for (int c = 0; c < 3; ++c)
            t[c] = mean_part(sigma[c] * w.t_end) * w.t_end;
    }
    return dot(deposit, t) / max(deposit.x + deposit.y + deposit.z, 1.0e-30);
}

// The first collision of a flight that goes through: at each step as much as that takes away.
void note_step(MediumParams v, MediumParams met, Spectrum deposit, float t, Lane lane, Rng rng) {
    if ((FLIGHT_TRAITS & TRAIT_CLOSED) != 0)
        t = lane.walk.start + collision_along(v, lane.walk, vec3(deposit), rng);
    vec3 position = lane.path.position + t * lane.path.direction;
    note_collision(lane.record, vec3(deposit), position, lane.path.direction, flown_before(lane) + t, albedo_at(met, position));
}

// Amid a flight: a null collision, or a step of a march through.
void touch(MediumParams v, Spectrum deposit, inout Lane lane, inout Rng rng) {
    float t = lane.walk.start + lane.walk.at;
    vec3 position = lane.path.position + t * lane.path.direction;
    MediumParams met = medium_of(v, lane.walk.met);
    uint next = TODO_FLY;
    uint label = label_at(lane, met);
    if (goes_through()) {
        if (EMISSION != EMISSION_NONE)
            add_light(lane, deposit * share_at(met, position, t, lane) * emitted_radiance(met, position),
                      glow_label(lane.path.depth) | label);
        if (HAS_LAYERS)
            note_step(v, met, deposit, t, lane, rng);
        next = largest(lane.beta) == 0.0 ? TODO_END : TODO_FLY;
    }
    lane.todo = next;
    if (NEE == NEE_TENTATIVE && lane.path.depth < frame.max_depth)
        gather_light(v, met, position, t, deposit * to_spectrum(albedo_at(met, position)),
                     kind_label(lane.path.depth + 1u) | label, next, lane, rng);
}

#endif
