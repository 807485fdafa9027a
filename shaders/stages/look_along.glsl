// A look toward a light from along the flight that comes next: see equiangular.glsl.
#ifndef STAGE_LOOK_ALONG_GLSL
#define STAGE_LOOK_ALONG_GLSL
#include "field/albedo.glsl"
#include "lights/equiangular.glsl"
#include "lights/table.glsl"
#include "stages/lane.glsl"

// One of those that have a place. Where there are many, one that the whole flight is lit by: chosen for a point of it, a light would
// be looked at from elsewhere with the chance that it had there. Weights do not depend on which one it is.
LightRow choose_placed(MediumParams v, vec3 position, vec3 direction, float reach, inout Rng rng, out float chance) {
    uint i = frame.choices - 1u;
    chance = 1.0;
    if (HAS_TREE) {
        vec2 t;
        if (!medium_interval(v, to_medium(v, position, direction), t))
            t = vec2(0.0);
        float clearest = max(v.usual_sigma_t * smallest(v.sigma_ratio), 1.0e-30); // of the channels, so that none is lost
        i = descend(Lit(position + t.x * direction, false, vec3(0.0), direction, max(min(t.y, reach) - t.x, 1.0e-30), clearest), rng, chance);
    }
    return light_at(i);
}

// Where shadow rays are walks, the lane goes to look, first along its way and then toward the light: true. Else what it
// would see is added here.
bool look_along(MediumParams v, inout Lane lane, inout Rng rng, inout Tally tally) {
    uvec4 words = next_words(rng);
    vec4 u = to_uniform(words);
    float chance;
    float reach = flying_as_far_as(lane);
    LightRow light = choose_placed(v, lane.path.position, lane.path.direction, reach, rng, chance);
    Stretch s = stretch_of(v, light, lane.path.position, lane.path.direction, reach);
    float t = distance_in(s, u.y);
    vec3 position = lane.path.position + t * lane.path.direction;
    tally.lookups += 1u;
    Matter matter = matter_at(v, to_medium(v, position, lane.path.direction).origin, to_tap(words), to_choice(words), lane.beta);
    MediumParams met = medium_of(v, matter.medium);
    LightSample drawn = sample_light(matter_of(met), light, position, lane.path.direction, next_words(rng), rng);
    // Over the density t was drawn with, times its weight.
    float per_pdf = 1.0 / (chance * (equiangular_pdf(s, t) + assumed_flight_pdf(v, s, t)));
    lane.lit = lane.beta * (per_pdf * (v.sigma_t * matter.density)) *
               (matter.ratio * matter.share * to_spectrum(albedo_at(met, position)));
    lane.light = drawn.light * phase_eval(met, lane.path.direction, drawn.direction);
    uint label = kind_label(lane.path.depth + 1u) | group_label(light.group) | label_at(lane, met);
    bool is_lit = is_open(s) && lane.path.depth < frame.max_depth && largest(lane.lit * lane.light) > 0.0;
    if (is_lit && SHADOW_RAYS_WALK) {
        lane.position = position;
        lane.to_light = drawn.direction;
        lane.light_distance = drawn.distance;
        lane.leg = LEG_ALONG;
        lane.label = label;
        if (HAS_SURFACES) {
            lane.lit_surface = NO_SURFACE;
            lane.lamp_body = light.body;
        }
        lane.resume = TODO_GO;
        lane.todo = TODO_LOOK;
        look_in_full(lane);
    } else if (is_lit) {
        add_light(lane,
                  lane.lit * transmittance_to(v, lane.path.position, lane.path.direction, t) *
                      transmittance_to(v, position, drawn.direction, drawn.distance) * lane.light,
                  label);
    }
    return is_lit && SHADOW_RAYS_WALK;
}

#endif
