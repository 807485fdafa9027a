// A path begins, at the camera.
#ifndef STAGE_GENERATE_GLSL
#define STAGE_GENERATE_GLSL
#include "sensors/camera.glsl"
#include "stages/lane.glsl"

void generate(inout Lane lane, out Rng rng) {
    CameraRay ray = camera_ray(lane.path.place, lane.path.sample_index);
    lane.path.position = ray.origin;
    lane.path.direction = ray.direction;
    lane.path.radiance = vec3(0.0);
    lane.path.draw = 0u;
    lane.path.depth = 0u;
    lane.beta = to_spectrum(vec3(1.0));
    lane.todo = TODO_DEPART;
    rng = pixel_rng(lane.path.place, lane.path.sample_index, 0u);
}

#endif
