// A vertex of a particle shows itself to the sensor.
#ifndef STAGE_SHOW_GLSL
#define STAGE_SHOW_GLSL
#include "film/splats.glsl"
#include "lights/families.glsl"
#include "sensors/toward_sensor.glsl"
#include "stages/lane.glsl"

bool is_particle(Lane lane) {
    return HAS_PARTICLES && lane.is_particle != 0u;
}

// At the first vertex, `distance` from where it began.
void note_shares(vec3 position, float distance, inout Lane lane) {
    if (lane.path.depth == 0u)
        lane.shares = is_particle(lane) ? shares_at(lane.shares, distance)
                                        : vec2(sensor_share(position, lane.path.direction, distance), 0.0);
}

// Whether the first vertex has scattered into one direction alone: then it is another share that counts.
void note_specular(inout Lane lane) {
    if (lane.path.depth == 1u)
        lane.shares.x = lane.shares.y;
}

// What of a light that a path finds is left to it.
float weight_of_found(Lane lane, vec2 light_shares, bool scattered) {
    return lane.path.depth == 0u ? 1.0 : weight_of_path(lane.shares.x, scattered ? light_shares.x : light_shares.y);
}

// A particle is one of as many as there are pixels.
void splat_of_particle(Lane lane, uint pixel, vec3 light) {
    float share = frame.particles.power / float(frame.crop_width * frame.crop_height);
    splat(pixel, lane.path.place, lane.path.sample_index, share * light);
}

// `value`: per steradian toward it, of light `lit` at `position`. Known at once in a homogeneous sphere or box, else the lane goes to
// look; then it does as `next` says.
void show(MediumParams v, SensorLook look, vec3 position, vec3 value, Spectrum lit, uint next, inout Lane lane) {
    value *= look.weight;
    if (WEIGHS && look.pixel != NO_PIXEL)
        value *= weight_of_particle(sensor_share(position, -look.direction, look.distance), lane.shares.x);
    bool is_seen = look.pixel != NO_PIXEL && largest(vec3(lit) * value) > 0.0;
    lane.todo = next;
    if (SHADOW_RAYS_WALK && is_seen) {
        lane.position = position;
        lane.lit = lit;
        lane.resume = next;
        lane.leg = LEG_LOOK;
        lane.lit_surface = surface_at(lane.path);
        lane.lamp_body = NO_SURFACE;
        lane.to_light = look.direction;
        lane.light_distance = look.distance;
        lane.light = value;
        lane.target = look.pixel;
        look_in_full(lane);
        lane.todo = TODO_LOOK;
    } else if (is_seen) {
        splat_of_particle(lane, look.pixel, lit * transmittance_to(v, position, look.direction, look.distance) * value);
    }
}

#endif
