// A path begins, at the camera.
#ifndef STAGE_GENERATE_GLSL
#define STAGE_GENERATE_GLSL
#include "lights/lamp.glsl"
#include "sensors/camera.glsl"
#include "stages/look_straight.glsl"

// Where the camera sees lamps, a look toward one of them comes before the first flight. Its random numbers begin behind the
// camera's draw, of which it takes what is left.
void look_at_lamps(MediumParams v, inout Lane lane, inout Rng rng) {
    LightSample seen = seen_lamp(lane.path.position, lane.path.direction, to_uniform(next_words(rng)).w);
    if (seen.distance == FAR) {
        rng.draw = 0u;
    } else if (LOOKS) {
        look_straight(seen, to_spectrum(vec3(1.0)), TODO_DEPART, lane);
    } else {
        lane.path.radiance = analytic_shadow(v, lane.path.position, seen.direction, seen.distance) * seen.light;
    }
}

void generate(MediumParams v, inout Lane lane, out Rng rng) {
    CameraRay ray = camera_ray(lane.path.place, lane.path.sample_index);
    lane.path.position = ray.origin;
    lane.path.direction = ray.direction;
    lane.path.radiance = vec3(0.0);
    lane.path.draw = 0u;
    lane.path.depth = 0u;
    if (HAS_SURFACES)
        lane.path.medium = 0u;
    lane.beta = to_spectrum(vec3(1.0));
    lane.todo = TODO_DEPART;
    rng = pixel_rng(lane.path.place, lane.path.sample_index, 0u);
    if (SEES_LAMPS)
        look_at_lamps(v, lane, rng);
}

#endif
