// A particle begins, at a light. Of all its vertices the sensor is looked for, and from where it begins too.
#ifndef STAGE_EMIT_GLSL
#define STAGE_EMIT_GLSL
#include "lights/particle.glsl"
#include "stages/show.glsl"

void emit(MediumParams v, inout Lane lane, inout Rng rng) {
    Particle p = emit_particle(v, rng);
    lane.is_particle = 1u;
    lane.path.position = p.position;
    lane.path.direction = p.direction;
    lane.path.depth = 0u;
    lane.path.medium = p.medium;
    lane.beta = to_spectrum(p.light);
    lane.begun_with = largest(p.light);
    lane.shares = p.shares;
    lane.todo = largest(p.light) > 0.0 ? TODO_DEPART : TODO_END;
    if (PATHS == PATHS_LIGHT && !COUNTS && lane.todo != TODO_END && p.shines != SHINES_UNSEEN) {
        SensorLook look = toward_sensor(p.position, rng);
        show(v, look, p.position, vec3(shine_toward(p, look.direction)), 0.0, lane.beta, TODO_DEPART, lane);
    }
}

#endif
