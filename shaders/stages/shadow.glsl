// A shadow ray has ended, at the light, at nothing left, or cut.
#ifndef STAGE_SHADOW_GLSL
#define STAGE_SHADOW_GLSL
#include "lights/directional.glsl"
#include "lib/trace.glsl"
#include "stages/show.glsl"

// At the end of the first leg of a look from along a flight, where the second begins.
void turn_to_light(Spectrum T, inout Lane lane) {
    lane.lit *= T;
    lane.leg = LEG_LOOK;
    lane.todo = largest(lane.lit) > 0.0 ? TODO_LOOK : lane.resume;
}

void end_look(MediumParams v, Spectrum T, inout Lane lane) {
    Spectrum more = NEE == NEE_CACHED ? (T - lane.cached) / lane.chance : T;
    vec3 light = LIGHTS == LIGHTS_LONE ? directional_contribution(medium_of(v, lit_medium(lane)), frame.lights[FRAME_DIRECTIONAL],
                                                         lane.path.direction, lit_beta(lane) * more)
                                      : lit_beta(lane) * more * lane.light;
    if (is_particle(lane))
        splat_of_particle(lane, lane.target, light);
    else
        add_light(lane, light, lane.label);
    lane.T = T;
    trace(TRACE_LIGHT, lane, looking_from(lane), looking_along(lane));
    lane.todo = after_looking(lane);
    if (NEE == NEE_TENTATIVE) {
        lane.walk = lane.flight;
        lane.search.stage = SEARCH_OVER;
    }
}

void end_shadow(MediumParams v, uint event, inout Lane lane) {
    Spectrum T = event == EVENT_LEFT ? end_transmittance(v, lane.walk, lane.T) : to_spectrum(vec3(0.0));
    if (is_along(lane))
        turn_to_light(T, lane);
    else
        end_look(v, T, lane);
}

#endif
