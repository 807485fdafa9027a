// A look toward a lamp that lies ahead: of the camera, or of what a mirror or glass shows.
#ifndef STAGE_LOOK_STRAIGHT_GLSL
#define STAGE_LOOK_STRAIGHT_GLSL
#include "lights/sample.glsl"
#include "stages/lane.glsl"

// Its light, of this label and of a lamp that has that body, counts as often as `lit` says; then the path does as `next` says.
void look_straight(LightSample seen, uint body, Spectrum lit, uint label, uint next, inout Lane lane) {
    lane.label = label;
    lane.position = lane.path.position;
    lane.lit = lit;
    lane.resume = next;
    lane.leg = LEG_LOOK;
    lane.to_light = seen.direction;
    lane.light_distance = seen.distance;
    lane.light = seen.light;
    if (HAS_SURFACES) {
        lane.lit_surface = surface_at(lane.path);
        lane.lamp_body = body;
    }
    look_in_full(lane);
    lane.todo = TODO_LOOK;
}

#endif
