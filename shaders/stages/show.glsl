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

// At the first vertex, `distance` from where it began, which it faces by the cosine `faces`; 1 in matter.
void note_shares(vec3 position, float distance, float faces, inout Lane lane) {
    if (lane.path.depth == 0u)
        lane.shares = is_particle(lane) ? shares_at(lane.shares, distance) * vec2(faces, 1.0)
                                        : vec2(sensor_share(position, lane.path.direction, distance) / faces, 0.0);
}

// The first vertex has scattered into one direction alone: then it is another share that counts.
void note_specular(inout Lane lane) {
    if (lane.path.depth == 1u)
        lane.shares.x = lane.shares.y;
}

// Or with `density`, see between.
void note_scattered(float density, inout Lane lane) {
    if (lane.path.depth == 1u)
        lane.shares.x = is_particle(lane) ? lane.shares.x * density : lane.shares.x / density;
}

// What of a light is left to the path that finds it, after it has scattered with `density`, or, if 0, into one direction alone.
float weight_of_found(Lane lane, vec2 light_shares, float density) {
    return lane.path.depth == 0u ? 1.0 : weight_of_path(lane.shares.x, density > 0.0 ? light_shares.x * density : light_shares.y);
}

// Of one that is looked for, at a vertex that `faces` it: from the first one before anything has scattered.
float weight_of_looked_for(Lane lane, vec2 light_shares, float faces, float density) {
    return weight_of_found(lane, light_shares, faces * (lane.path.depth > 1u ? density : 1.0));
}

// A particle is one of as many as there are pixels.
void splat_of_particle(Lane lane, uint pixel, vec3 light) {
    float share = frame.particles.power / float(frame.crop_width * frame.crop_height);
    splat(pixel, lane.path.place, lane.path.sample_index, share * light);
}

// The sensor's share at a vertex `s` that a particle shows.
float share_of_shown(Scatterer s, SensorLook look, vec3 position, float density, Lane lane) {
    float share = sensor_share(position, -look.direction, look.distance) / facing(s, look.direction);
    return lane.path.depth > 1u ? share / density : share;
}

// `value`: per steradian toward it, of light `lit` at `position`; `share`: see share_of_shown. Known at once in a homogeneous sphere or
// box, else the lane goes to look; then it does as `next` says.
void show(MediumParams v, SensorLook look, vec3 position, vec3 value, float share, Spectrum lit, uint next, inout Lane lane) {
    value *= look.weight;
    if (WEIGHS && look.pixel != NO_PIXEL)
        value *= weight_of_particle(share, lane.shares.x);
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
