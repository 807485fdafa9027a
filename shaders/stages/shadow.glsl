// A shadow ray has ended, at the light, at nothing left, or cut.
#ifndef STAGE_SHADOW_GLSL
#define STAGE_SHADOW_GLSL
#include "lights/light.glsl"
#include "lib/trace.glsl"

void end_shadow(MediumParams v, uint event, inout Lane lane) {
    Spectrum T = event == EVENT_LEFT ? end_transmittance(v, lane.walk, lane.T) : to_spectrum(vec3(0.0));
    if (is_along(lane)) { // the other leg follows
        lane.lit *= T;
        lane.leg = LEG_LOOK;
        lane.todo = largest(lane.lit) > 0.0 ? TODO_LOOK : lane.resume;
        return;
    }
    Spectrum more = NEE == NEE_CACHED ? (T - lane.cached) / lane.chance : T;
    lane.path.radiance +=
        LIGHTS == LIGHTS_SUN ? sun_contribution(v, frame.lights[LIGHT_SUN], lane.path.direction, lit_beta(lane) * more)
                             : lit_beta(lane) * more * lane.light;
    lane.T = T;
    trace(TRACE_LIGHT, lane, looking_from(lane), looking_along(lane));
    lane.todo = after_looking(lane);
    if (NEE == NEE_TENTATIVE) {
        lane.walk = lane.flight;
        lane.search.stage = SEARCH_OVER;
    }
}

#endif
