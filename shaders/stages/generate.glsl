// A path begins, at the camera.
#ifndef STAGE_GENERATE_GLSL
#define STAGE_GENERATE_GLSL
#include "lights/lamp.glsl"
#include "sensors/flux.glsl"
#include "stages/look_straight.glsl"

// A look from the sensor comes before the first flight.
void look_first(MediumParams v, LightSample seen, uint i, inout Lane lane) {
    LightRow row = light_at(i);
    uint label = (row.body != NO_SURFACE ? SOLID : 0u) | kind_label(0u) | group_label(row.group);
    if (SEES_GLOW && row.kind == LIGHT_GLOW)
        label = glow_label(0u) | row.pieces << MEDIUM_BIT;
    if (SHADOW_RAYS_WALK) {
        look_straight(seen, row.body, to_spectrum(vec3(1.0)), label, TODO_DEPART, lane);
    } else {
        add_light(lane, transmittance_to(v, lane.path.position, seen.direction, seen.distance) * seen.light, label);
    }
}

// Where the camera sees lamps, toward one of them. Random numbers begin behind the camera's draw, of which it takes what is left.
void look_at_lamps(MediumParams v, inout Lane lane, inout Rng rng) {
    uint row;
    LightSample seen = seen_lamp(lane.path.position, lane.path.direction, to_uniform(next_words(rng)).w, row);
    if (seen.distance == FAR)
        rng.draw = 0u;
    else
        look_first(v, seen, row, lane);
}

// Where flux is read, toward a light. Random numbers begin behind the camera's draw.
void look_at_lights(MediumParams v, inout Lane lane, inout Rng rng) {
    rng.draw = 1u;
    uint row;
    LightSample seen = look_from_sensor(lane.path.position, lane.path.direction, rng, row);
    if (largest(seen.light) > 0.0)
        look_first(v, seen, row, lane);
}

// Where particles are all there is, along the ray for what is beyond: nothing that they come from there would meet a camera.
void look_beyond(MediumParams v, inout Lane lane, inout Rng rng) {
    rng.draw = 1u; // behind the camera's
    vec3 light = frame.lights[FRAME_BACKGROUND].radiance;
    if (SEES_SKY)
        light += light_from_beyond(lane.path.direction, 0.0);
    LightSample seen = LightSample(lane.path.direction, FAR, light, 0.0);
    lane.todo = TODO_END;
    if (largest(light) > 0.0 && SHADOW_RAYS_WALK)
        look_straight(seen, NO_SURFACE, to_spectrum(vec3(1.0)), 0u, TODO_END, lane);
    else if (largest(light) > 0.0)
        add_light(lane, transmittance_to(v, lane.path.position, seen.direction, FAR) * light, 0u);
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
    lane.first_label = 0u;
    lane.is_particle = 0u;
    lane.begun_with = 1.0;
    if (HAS_LAYERS)
        begin_record(lane.record);
    rng = pixel_rng(lane.path.place, lane.path.sample_index, 0u);
    if (SEES_LAMPS && !READS_FLUX && PATHS != PATHS_LIGHT)
        look_at_lamps(v, lane, rng);
    if (READS_FLUX) // in an `if` of its own, which kernels without such sensors are compiled without
        if (LOOKS_FROM_SENSOR)
            look_at_lights(v, lane, rng);
    if (PATHS == PATHS_LIGHT && !COUNTS)
        look_beyond(v, lane, rng);
    if (COUNTS)
        lane.todo = TODO_END;
}

#endif
