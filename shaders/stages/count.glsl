// Particles that pass a sensor of flux, from the side that it reads, are counted by it; or what they leave in its cells.
#ifndef STAGE_COUNT_GLSL
#define STAGE_COUNT_GLSL
#include "stages/show.glsl"

// World units before the sensor's plane, which is a little before that of a surface that it lies in (kept_apart.cpp): particles that
// come to the surface have passed then, and those that leave it, from a little off it, have not.
float before_sensor(vec3 position) {
    return dot(position - frame.sensors[0].position, frame.sensors[0].corner);
}

// Where a domain repeats so does the sensor, which is in one of them: see particle_scenes.h.
vec3 at_sensor(vec3 position) {
    vec3 size = mix(frame.period.size, vec3(1.0), equal(frame.period.size, vec3(0.0)));
    return REPEATS ? position - frame.period.size * floor((position - frame.particles.sensor_low) / size) : position;
}

// The sensor's pixel there, and what a particle's power comes to in it, per area.
uint pixel_passed(vec3 position, Lane lane, out float weight) {
    SensorParams s = frame.sensors[0];
    position = at_sensor(position);
    vec2 u = vec2(0.0); // for filters alone
    if (PIXEL_FILTER != PIXEL_EVEN)
        u = to_uniform(pcg4d(uvec4(floatBitsToUint(position), lane.path.place ^ lane.path.sample_index))).xy;
    vec3 q = position - s.position;
    uint pixel = pixel_at(vec2(dot(q, s.right) / dot(s.right, s.right), dot(q, s.down) / dot(s.down, s.down)), u, weight);
    weight /= length(s.right) * length(s.down); // at right angles
    return pixel;
}

// Along a part of a flight, to `to`, or on for ever. Both ends are told before or behind the sensor, so that of parts that follow each
// other exactly one passes it.
void count_passing(vec3 from, bool ends, vec3 to, Lane lane) {
    vec3 direction = lane.path.direction;
    float before = before_sensor(from);
    float behind = ends ? -before_sensor(to) : FAR;
    float slope = -dot(direction, frame.sensors[0].corner);
    if (!(before > 0.0 && behind >= 0.0 && slope > 0.0))
        return;
    float weight;
    uint pixel = pixel_passed(from + before / slope * direction, lane, weight);
    if (pixel != NO_PIXEL)
        splat_of_particle(lane, pixel, weight * vec3(lane.beta));
}

// At the end of a part of a flight from there. That the throughput knows what came behind the sensor is on average no matter, since until
// its albedo is applied a collision leaves it as it was on average.
void count_flight(MediumParams v, vec3 from, uint event, Lane lane) {
    bool collided = event == EVENT_COLLIDED;
    float t = flying_as_far_as(lane);
    if (!collided && !NULL_FLIGHT)
        lane.beta *= depth_weight(v, lane.beta, lane.walk.depth, false);
    vec3 to = collided ? lane.path.position : from + t * lane.path.direction;
#ifdef SURFACES
    // A long flight's end is known to ulps of its length, and a sensor may lie in the surface.
    if (event == EVENT_LEFT && t < FAR && t == lane.reach)
        to = surface_point(lane.struck, to).position;
#endif
    if (collided || event == EVENT_LEFT)
        count_passing(from, collided || t < FAR, to, lane);
}

// Counts the power that a collision absorbs, per volume.
void count_absorbed(vec3 position, vec3 power, Lane lane) {
    SensorParams s = frame.sensors[0];
    ivec3 cell = ivec3(clamp(floor((at_sensor(position) - s.position) / s.corner), vec3(-1.0), vec3(s.cells)));
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, s.cells)))
        return;
    float unused;
    uint pixel = pixel_at(vec2(cell.x, s.cells.y - 1 - cell.y + s.cells.y * cell.z) + 0.5, vec2(0.0), unused);
    if (pixel != NO_PIXEL)
        splat_of_particle(lane, pixel, power / (s.corner.x * s.corner.y * s.corner.z));
}

#endif
