// A segment begins: a flight from the camera or from a vertex, where the path scatters first, or a shadow ray.
#ifndef STAGE_DEPART_GLSL
#define STAGE_DEPART_GLSL
#include "lights/light_cache.glsl"
#include "lib/trace.glsl"
#include "sensors/flux.glsl"
#include "stages/look_along.glsl"
#include "stages/look_straight.glsl"
#include "stages/seam.glsl"
#include "stages/show.glsl"
#include "surfaces/nearest.glsl"

// Russian roulette on the throughput: unbiased, survivors are raised to the threshold. Of particles it is what they have left of what
// they began with that counts: those of a weak light beside a strong one begin with little.
bool survives(inout Lane lane, float u) {
    float m = largest(lane.beta), threshold = frame.roulette_threshold * begun_with(lane);
    if (m >= threshold)
        return true;
    bool alive = u * threshold < m;
    lane.beta *= alive ? threshold / m : 0.0;
    return alive;
}

// The words of the draw with which a segment begins. A shadow ray known in closed form leaves nothing to chance.
uvec4 first_words(bool looks, inout Rng rng) {
    uint drawn = rng.draw;
    uvec4 words = next_words(rng);
    if (looks && (SHADOW_TRAITS & TRAIT_CLOSED) != 0)
        rng.draw = drawn;
    return words;
}

// Scatters, or ends by roulette.
void scatter(MediumParams v, vec4 u, inout Lane lane) {
    vec3 before = lane.path.direction;
    lane.path.direction = phase_sample(v, before, u.yz);
    if (MEETS_LIGHTS || WEIGHS)
        lane.phase_pdf = phase_eval(v, before, lane.path.direction);
    if (WEIGHS)
        note_scattered(between(false, lane.phase_pdf), lane);
    lane.todo = survives(lane, u.w) ? TODO_FLY : TODO_END;
    if (LIGHTS == LIGHTS_LONE) // in an `if` of its own, as below
        if (SHADOW_RAYS_WALK && NEE == NEE_CACHED && PHASE_HAS_TWICE && lane.path.depth < frame.max_depth)
            add_light(lane,
                      -lane.beta * frame.lights[FRAME_DIRECTIONAL].radiance *
                          foreseen_light(v, lane.path.position, lane.cached, before, lane.path.direction),
                      kind_label(lane.path.depth + 1u) | group_label(frame.lights[FRAME_DIRECTIONAL].group) | lane.first_label);
}

#ifdef SURFACES
// Within glass whose faces stand for something round light may go about for ever, and loses nothing; likewise between mirrors, or
// white walls: roulette that does not ask for throughput, after so many vertices that it is seldom asked. Chances that multiply to the
// square of 1 / depth end every path; and whatever share of the light a vertex leaves, if not all, weights of no more than the square of
// depth, where a fixed chance's grow as its power, have a bounded variance.
bool goes_on_within(bool stays_within, uint depth, inout Spectrum beta, inout float u) {
    float root = float(depth) / float(depth + 1u), chance = root * root;
    bool asked = depth >= (stays_within ? 32u : 256u) && frame.roulette_threshold > 0.0;
    bool goes_on = !asked || u < chance;
    beta *= !asked ? 1.0 : goes_on ? 1.0 / chance : 0.0;
    u = asked ? u / chance : u;
    return goes_on;
}

// Likewise at a surface.
void scatter_at_surface(uvec4 words, inout Lane lane, inout Rng rng) {
    vec3 wo = -lane.path.direction;
    SurfacePoint at = surface_point(surface_at(lane.path), lane.path.position);
    vec4 u = to_uniform(words);
    uvec4 key = takes_walks() ? next_words(rng) : uvec4(0u);
    Bsdf bsdf = bsdf_of(row_at(at), at, wo, key);
    float draws = 1.0;
    bool chooses_normal = HAS_SMOOTH_FACES && is_particle(lane);
    if (HAS_SMOOTH_FACES && HAS_PARTICLES)
        if (chooses_normal)
            bsdf = particle_bsdf(bsdf, wo, u.w, draws);
    BsdfSample drawn = bsdf_sample(bsdf, wo, lane.beta, u.yzx);
    bool crosses = dot(drawn.direction, bsdf.face) < 0.0;
    lane.path.position = at.position + (crosses ? -at.apart : at.apart) * bsdf.face;
    lane.path.direction = drawn.direction;
    lane.phase_pdf = drawn.pdf;
    if (WEIGHS && drawn.pdf == 0.0)
        note_specular(lane);
    else if (WEIGHS)
        note_scattered(between(true, drawn.pdf), lane);
    lane.beta *= drawn.weight;
    if (is_particle(lane))
        lane.beta *= bsdf_adjoint(bsdf, wo, drawn.direction);
    if (HAS_SMOOTH_FACES && HAS_PARTICLES)
        lane.beta *= !chooses_normal ? 1.0 : has_drawn_as_seen(bsdf, drawn.direction) ? draws : 0.0;
    bool goes_on = goes_on_within(is_glass(bsdf.material) && dot(at.normal, wo) < 0.0 && !crosses, lane.path.depth, lane.beta, u.w);
    lane.todo = goes_on && survives(lane, u.w) ? TODO_FLY : TODO_END;
}

// What mirrors and glass show of lamps is seen as the camera sees them.
bool look_at_shown_lamps(inout Lane lane, inout Rng rng) {
    bool is_shown = !is_particle(lane) && lane.todo == TODO_FLY && surface_at(lane.path) != NO_SURFACE && lane.phase_pdf == 0.0;
    uint row;
    LightSample seen = seen_lamp(lane.path.position, lane.path.direction, to_uniform(next_words(rng)).w, row);
    bool sees = is_shown && seen.distance < FAR;
    uint label = kind_label(lane.path.depth) | group_label(light_at(row).group) | lane.first_label;
    if (sees && WEIGHS)
        seen.light *= weight_of_found(lane, shares_of_found(light_at(row), lane.path.position, seen.direction, seen.distance, 0.0), 0.0);
    if (sees)
        look_straight(seen, light_at(row).body, lane.beta, label, TODO_SET_OUT, lane);
    return sees;
}
#endif

// A part of the flight or shadow ray, with what is left of its optical depth.
void begin_here(MediumParams v, bool looks, inout Lane lane) {
    begin_segment(v, looks ? looking_from(lane) : lane.path.position,
                  looks ? looking_along(lane) : lane.path.direction,
                  looks ? looking_as_far_as(lane) : flying_as_far_as(lane), looks, lane.walk, lane.search);
}

// The flight or shadow ray itself.
void set_going(MediumParams v, uvec4 words, bool looks, bool at_camera, inout Lane lane) {
    float e = to_exponential(at_camera ? words.z : words.x, words);
    lane.walk.tau = looks ? e : begin_flight(v, lane.beta, e, to_tap(words).z);
    lane.walk.depth = 0.0;
    if (SHADOW_RAYS_WALK && looks)
        begin_transmittance(words, lane.walk);
    bool is_first = !looks && lane.path.depth == 0u && !is_particle(lane);
    lane.walk.least = SPLITS && is_first && reach_of_flight(lane) >= FAR ? LEAST_IN_CELL : 0.0;
    lane.split.collided = 0.0;
    begin_here(v, looks, lane);
    lane.T = to_spectrum(vec3(1.0));
    lane.steps = 0u;
}

#ifdef SURFACES
// The primitive that a segment begins at, or NO_SURFACE.
uint begins_at(bool looks, Lane lane) {
    uint from = looks ? lane.lit_surface : surface_at(lane.path);
    return REPEATS && lane.seams != 0u ? NO_SURFACE : from;
}

// How far surfaces may be in the way of a look: not as far as a light, or sensor, that lies in a surface's plane.
float seeking_as_far_as(Lane lane) {
    float reach = looking_as_far_as(lane);
    vec3 from = looking_from(lane), to = from + reach * looking_along(lane);
    return REPEATS || reach >= FAR ? reach : reach - 2.0 * spare_at(max(abs(from), abs(to)));
}

void begin_seeking(bool looks, inout Lane lane) {
    Ray ray = Ray(looks ? looking_from(lane) : lane.path.position, looks ? looking_along(lane) : lane.path.direction);
    lane.seek = begin_seek(ray, looks ? seeking_as_far_as(lane) : FAR, begins_at(looks, lane));
    lane.todo = looks ? TODO_CHECK : lane.todo == TODO_FLY ? TODO_SEEK : lane.todo;
}
#endif

// At once or, where there are surfaces, once these have been asked, unless it `knows` that none is in the way.
void begin_going(MediumParams v, uvec4 words, bool looks, bool at_camera, bool knows, inout Lane lane, inout Tally tally) {
    if (NEE == NEE_TENTATIVE && looks)
        lane.flight = lane.walk;
    if (REPEATS)
        enter_domain(looks, lane);
#ifdef SURFACES
    if (!knows)
        begin_seeking(looks, lane);
    else
#endif
        set_going(v, words, looks, at_camera, lane);
    tally.shadow_rays += looks ? 1u : 0u;
    if (!looks && !(HAS_SURFACES && knows)) // else the search has begun there
        trace(is_particle(lane) && lane.path.depth == 0u ? TRACE_EMIT : TRACE_DEPART, lane, lane.path.position,
              lane.path.direction);
}

// Behind a seam the segment goes on, once surfaces have been asked there.
void go_on_across(MediumParams v, bool looks, inout Lane lane) {
#ifdef SURFACES
    lane.todo = looks ? TODO_SEE : TODO_FLY;
    begin_seeking(looks, lane);
#else
    begin_here(v, looks, lane);
#endif
}

void depart(MediumParams v, inout Lane lane, inout Rng rng, inout Tally tally) {
    bool looks = at_shadow_ray(lane.todo == TODO_LOOK);
    bool has_looked = sets_out_again(lane.todo);
    bool knows = LOOKS_ALONG && (looks ? is_along(lane) : lane.todo == TODO_GO);
    bool at_camera = !looks && lane.path.depth == 0u;
    uvec4 words = first_words(looks, rng);
    lane.todo = looks ? TODO_SEE : TODO_FLY;
    if (MEETS_LIGHTS && at_camera)
        lane.phase_pdf = READS_FLUX ? flux_pdf(lane.path.direction) : 0.0;
    bool scatters = !looks && !at_camera && !has_looked;
#ifdef SURFACES
    if (scatters && surface_at(lane.path) != NO_SURFACE)
        scatter_at_surface(words, lane, rng);
    scatters = scatters && surface_at(lane.path) == NO_SURFACE;
#endif
    if (scatters)
        scatter(medium_of(v, lane.path.medium), to_uniform(words), lane);
    bool goes_to_look = false;
#ifdef SURFACES
    if (SEES_LAMPS && SHADOW_RAYS_WALK)
        if (!looks && !at_camera && !has_looked)
            goes_to_look = look_at_shown_lamps(lane, rng);
#endif
    if (LOOKS_ALONG && !HAS_SURFACES) // in an `if` of its own, which the compiler leaves out with all it leads to
        if (lane.todo == TODO_FLY && !has_looked)
            goes_to_look = look_along(v, lane, rng, tally);
    if (!goes_to_look)
        begin_going(v, words, looks, at_camera, knows, lane, tally);
}

#endif
