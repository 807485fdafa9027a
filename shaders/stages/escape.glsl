// A flight leaves the medium, into the background.
#ifndef STAGE_ESCAPE_GLSL
#define STAGE_ESCAPE_GLSL
#include "lights/table.glsl"
#include "lib/trace.glsl"

void escape(MediumParams v, inout Lane lane) {
    Spectrum beta = lane.beta;
    if (!NULL_FLIGHT && !goes_through())
        beta *= depth_weight(v, beta, lane.walk.depth, false);
    lane.path.radiance += beta * frame.lights[LIGHT_BACKGROUND].radiance;
    if (SEES_SKY)
        lane.path.radiance += beta * light_from_beyond(lane.path.direction, lane.phase_pdf);
    trace(TRACE_ESCAPE, lane, lane.path.position, lane.path.direction);
    lane.todo = TODO_END;
}

#endif
