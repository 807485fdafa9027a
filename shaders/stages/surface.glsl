// A flight meets a surface: emission, reflection, light. Then the path departs from there, or ends.
#ifndef STAGE_SURFACE_GLSL
#define STAGE_SURFACE_GLSL
#include "stages/collide.glsl"

#ifdef SURFACES
// What shines on both sides, or on the side that is seen; of what is looked for, too, the flight's share.
vec3 surface_emission(SurfaceRow row, vec3 normal, Lane lane) {
    float cosine = dot(normal, lane.path.direction);
    vec3 emission = row.sides == 2u || cosine < 0.0 ? row.emission : vec3(0.0);
    return SEES_SURFACES ? emission * share_of_met(row, cosine, lane.reach, lane.phase_pdf) : emission;
}

void arrive_at_surface(MediumParams v, inout Lane lane, inout Rng rng, inout Tally tally) {
    if (!NULL_FLIGHT && !goes_through())
        lane.beta *= depth_weight(v, lane.beta, lane.walk.depth, false);
    SurfacePoint at = surface_point(lane.struck, lane.path.position + lane.reach * lane.path.direction);
    SurfaceRow row = row_at(at);
    if (!is_particle(lane))
        add_light(lane, lane.beta * surface_emission(row, at.normal, lane),
                  SOLID | kind_label(lane.path.depth) | lane.first_label);
    uvec4 key = takes_walks() ? next_words(rng) : uvec4(0u);
    Bsdf bsdf = bsdf_of(row, at, -lane.path.direction, key);
    if (HAS_LAYERS)
        if (lane.path.depth == 0u) {
            note_collision(lane.record, vec3(lane.beta), at.position, lane.path.direction, flown_before(lane) + lane.reach,
                           row.color);
            note_normal(lane.record, vec3(lane.beta), bsdf.normal);
        }
    lane.path.position = at.position + at.apart * bsdf.face;
    if (WEIGHS)
        note_shares(lane.path.position, lane.reach, facing(surface_of(v, bsdf, at.apart), lane.path.direction), lane);
    lane.path.medium = AT_SURFACE | lane.struck;
    bool capped = SCATTERING != SCATTERING_NONE && lane.path.depth >= frame.max_depth;
    tally.depth_caps += capped ? 1u : 0u;
    lane.path.depth += 1u;
    bool ended = capped || SCATTERING == SCATTERING_NONE || largest(lane.beta) == 0.0 || is_black(bsdf);
    lane.todo = ended || SCATTERING == SCATTERING_SINGLE ? TODO_END : TODO_DEPART;
    if (NEE != NEE_NONE && !ended && is_rough(bsdf) && is_particle(lane))
        show_to_sensor(v, surface_of(v, bsdf, at.apart), lane.path.position, lane.beta, lane.todo, lane, rng);
    else if (NEE != NEE_NONE && !ended && is_rough(bsdf))
        gather_some_light(v, surface_of(v, bsdf, at.apart), lane.path.position, 0.0, lane.beta,
                          kind_label(lane.path.depth) | lane.first_label, lane.todo, lane, rng);
    trace(TRACE_SURFACE, lane, lane.path.position, lane.path.direction);
}
#endif

#endif
