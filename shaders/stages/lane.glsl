// A path as a lane holds it.
#ifndef LANE_GLSL
#define LANE_GLSL
#include "film/aovs.glsl"
#include "sensors/camera.glsl"
#include "shapes/period.glsl"
#include "shapes/segment.glsl"

struct Lane {
    PathState path;
    uint todo;
    uint record; // of its layers: fused, of its slot; staged, of the sample's place among those that wait
    PATH_STATE(STATE_FIELD_WHEN)
    LOOK_STATE(STATE_FIELD_WHEN)
    SEGMENT_STATE(STATE_FIELD_WHEN)
};

// The fused schedule's one pass has flights and shadow rays; of the staged ones each has its own, and what only the other
// would do is not compiled. `is`: whether a lane of the fused one is at a shadow ray.
bool at_shadow_ray(bool is) {
#if defined(FLIGHTS_ONLY)
    return false;
#elif defined(SHADOW_RAYS_ONLY)
    return SHADOW_RAYS_WALK;
#else
    return SHADOW_RAYS_WALK && is;
#endif
}

// Whether paths may come to look along the way that they have drawn, before they go it: toward lamps that mirrors and glass show,
// and, once its end is known, from along it.
const bool SETS_OUT = LOOKS_ALONG || HAS_SURFACES;
bool sets_out_again(uint todo) {
    return SETS_OUT && ((HAS_SURFACES && todo == TODO_SET_OUT) || (LOOKS_ALONG && todo == TODO_GO));
}

// Whether a lane begins a segment, or goes on along one, of a kind that its pass has.
bool departs(uint todo) {
    bool sets_out = sets_out_again(todo);
#if defined(FLIGHTS_ONLY)
    return todo == TODO_DEPART || sets_out;
#elif defined(SHADOW_RAYS_ONLY)
    return todo == TODO_LOOK;
#else
    return todo == TODO_DEPART || todo == TODO_LOOK || sets_out;
#endif
}
// Whether a lane seeks the surface that ends a flight, or is in the way of a shadow ray.
bool seeks(uint todo) {
#if !defined(SURFACES)
    return false;
#elif defined(FLIGHTS_ONLY)
    return todo == TODO_SEEK;
#elif defined(SHADOW_RAYS_ONLY)
    return todo == TODO_CHECK;
#else
    return todo == TODO_SEEK || todo == TODO_CHECK;
#endif
}
bool is_under_way(uint todo) {
#if defined(FLIGHTS_ONLY)
    return todo == TODO_FLY;
#elif defined(SHADOW_RAYS_ONLY)
    return todo == TODO_SEE;
#else
    return todo == TODO_FLY || todo == TODO_SEE;
#endif
}

// What the shadow ray lights, and from where. At collisions that is the path's own vertex, and need not be kept.
const bool KEEPS_PLACE = NEE == NEE_TENTATIVE || LOOKS_ALONG || HAS_SURFACES || HAS_PARTICLES || REPEATS;
Spectrum lit_beta(Lane lane) {
    return KEEPS_PLACE ? lane.lit : lane.beta;
}
uint lit_medium(Lane lane) {
    return KEEPS_PLACE ? lane.lit_medium : lane.path.medium;
}
bool is_along(Lane lane) {
    return LOOKS_ALONG && lane.leg == LEG_ALONG;
}
vec3 looking_from(Lane lane) {
    return KEEPS_PLACE && !is_along(lane) ? lane.position : lane.path.position;
}
vec3 looking_along(Lane lane) {
    return LIGHTS == LIGHTS_LONE ? frame.lights[FRAME_DIRECTIONAL].direction : is_along(lane) ? lane.path.direction : lane.to_light;
}
// World units, how far it is to the light.
float reach_of_look(Lane lane) {
    return LIGHTS == LIGHTS_LONE ? FAR
           : is_along(lane)     ? distance(lane.path.position, lane.position)
                                : lane.light_distance;
}
// World units, how far the present part of the look goes, where a domain repeats.
float looking_as_far_as(Lane lane) {
    ivec3 axis;
    return REPEATS ? seam_ahead(looking_from(lane), looking_along(lane), FAR, axis) : reach_of_look(lane);
}
// The primitive that the path is at, or NO_SURFACE.
uint surface_at(PathState path) {
    return (path.medium & AT_SURFACE) != 0u ? path.medium & ~AT_SURFACE : NO_SURFACE;
}
// How far a flight goes, unless it collides.
float reach_of_flight(Lane lane) {
#ifdef SURFACES
    return lane.reach;
#else
    return FAR;
#endif
}
// Likewise the present part of it.
float flying_as_far_as(Lane lane) {
    float reach = reach_of_flight(lane);
    ivec3 axis;
    return REPEATS ? min(reach, seam_ahead(lane.path.position, lane.path.direction, reach, axis)) : reach;
}
// World units, of the flight, before it came to where the path's position now is.
float flown_before(Lane lane) {
    return REPEATS ? lane.flown : 0.0;
}
// What its throughput is compared with.
float begun_with(Lane lane) {
    return HAS_PARTICLES || SPLITS ? lane.begun_with : 1.0;
}
// One that corrects no cache.
void look_in_full(inout Lane lane) {
    lane.cached = to_spectrum(vec3(0.0));
    lane.chance = 1.0;
}
uint after_looking(Lane lane) {
    bool at_camera = (SEES_LAMPS || LOOKS_FROM_SENSOR) && lane.path.depth == 0u;
    return KEEPS_PLACE                                        ? lane.resume
           : SCATTERING == SCATTERING_SINGLE && !at_camera ? TODO_END
                                                              : TODO_DEPART;
}

// Light that a path has gathered, with its label: see aovs.glsl.
void add_light(inout Lane lane, vec3 light, uint label) {
    lane.path.radiance += held_out(light, label);
    if (HAS_LAYERS)
        note_light(lane.record, label, light);
}

// Part of the label of light that the path gathers where it is `met`, at its first vertex or later.
uint label_at(Lane lane, MediumParams met) {
    return lane.path.depth == 0u ? medium_label(met) : lane.first_label;
}

#endif
