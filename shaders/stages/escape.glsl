// A flight leaves the medium, into the background.
#ifndef STAGE_ESCAPE_GLSL
#define STAGE_ESCAPE_GLSL
#include "lights/table.glsl"
#include "lib/trace.glsl"
#include "stages/show.glsl"

// Each light in its group's layer, and what of a sensor's ray has come `through`.
void note_escape(Spectrum beta, Spectrum through, uint label, vec3 direction, Lane lane) {
    note_light(lane.record, label | group_label(frame.lights[FRAME_BACKGROUND].group),
               beta * frame.lights[FRAME_BACKGROUND].radiance);
    if (SEES_SKY)
        for (uint i = 0u; i < frame.sky_count; ++i)
            note_light(lane.record, label | group_label(light_at(i).group),
                       beta * light_from_one(light_at(i), direction, lane.phase_pdf));
    if (lane.path.depth == 0u)
        note_transmittance(lane.record, vec3(through));
}

// The path's part of the light of all that a flight meets when it leaves.
vec3 light_left_to_path(vec3 direction, Lane lane) {
    vec3 radiance = vec3(0.0);
    bool is_surface = surface_at(lane.path) != NO_SURFACE;
    float density = lane.phase_pdf > 0.0 ? between(is_surface, lane.phase_pdf) : 0.0;
#ifdef SURFACES
    if (is_surface)
        density *= max(abs(dot(surface_point(surface_at(lane.path), lane.path.position).normal, direction)), 1.0e-6);
#endif
    for (uint i = 0u; i < frame.sky_count; ++i) {
        LightRow light = light_at(i);
        vec2 shares = shares_of_found(light, lane.path.position, direction, FAR, pdf_from_beyond(light, direction));
        radiance += weight_of_found(lane, shares, density) * light_from_one(light, direction, lane.phase_pdf);
    }
    return radiance;
}

// What of a split flight has collided where it would find nothing, which only layers know.
void note_unfollowed(MediumParams v, Lane lane) {
    vec3 position = lane.path.position + lane.split.at * lane.path.direction;
    note_collision(lane.record, vec3(lane.split.picked * lane.split.collided), position, lane.path.direction,
                   flown_before(lane) + lane.split.at, albedo_at(medium_of(v, lane.split.met), position));
}

// `direction`: the path's. After a flight that was split the path may go on, with what has collided: then
// `lane.split` still has that.
void escape(MediumParams v, vec3 direction, inout Lane lane, inout Rng rng) {
    if (is_particle(lane)) {
        lane.todo = TODO_END;
        return;
    }
    Spectrum beta = lane.beta;
    if (!NULL_FLIGHT && !goes_through())
        beta *= depth_weight(v, beta, lane.walk.depth, false);
    uint label = kind_label(lane.path.depth) | lane.first_label;
    vec3 light = held_out(frame.lights[FRAME_BACKGROUND].radiance, label);
    if (SEES_SKY && WEIGHS)
        light += light_left_to_path(direction, lane);
    else if (SEES_SKY)
        light += held_out(light_from_beyond(direction, lane.phase_pdf), label);
    lane.todo = TODO_END;
    Spectrum through = beta;
    if (SPLITS) // in an `if` of its own, which kernels without it are compiled without
        if (lane.split.collided > 0.0) {
            if (HAS_LAYERS)
                if (finds_nothing())
                    note_unfollowed(v, lane);
            beta += stand_in(light, beta, lane.beta, lane.begun_with, lane.split, rng);
        }
    if (HAS_LAYERS)
        note_escape(beta, through, label, direction, lane);
    lane.path.radiance += beta * light;
    trace(TRACE_ESCAPE, lane, lane.path.position, lane.path.direction);
}

#endif
