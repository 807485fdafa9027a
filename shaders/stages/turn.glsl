// A turn: what befalls a lane until it is asked again where it stands, of all stages that its pass has.
#ifndef STAGE_TURN_GLSL
#define STAGE_TURN_GLSL
#include "stages/collide.glsl"
#include "stages/count.glsl"
#include "stages/depart.glsl"
#include "stages/emit.glsl"
#include "stages/escape.glsl"
#include "stages/seek.glsl"
#include "stages/shadow.glsl"
#include "stages/surface.glsl"
#include "stages/track.glsl"

// llvmpipe carries out both sides of an `if`: what lanes that have nothing to do there look up is not used, but where it is random, in
// a map of the sky say, it empties caches. So they have the same numbers, whatever theirs are, and the same direction. Chosen before
// the `if`, within which the compiler would know better.
Rng numbers_of(bool is_needed, Rng rng) {
    Rng numbers = rng;
    if (HAS_SKY_MAP)
        if (!is_needed)
            numbers = Rng(0u, 0u, 0u, 0u);
    return numbers;
}
vec3 direction_of(bool is_needed, vec3 direction) {
    return HAS_SKY_MAP && !is_needed ? vec3(0.0, 1.0, 0.0) : direction;
}

// What the present segment met, if anything, and what follows.
void arrive(MediumParams v, uint event, Spectrum deposit, inout Lane lane, inout Rng rng, inout Tally tally) {
    bool seeing = at_shadow_ray(lane.todo == TODO_SEE);
    bool goes_on = false;
    if (REPEATS)
        if (event == EVENT_LEFT)
            goes_on = passes_seam(seeing, event, lane, tally);
    bool leaves = !seeing && event == EVENT_LEFT;
    bool splits = SPLITS && leaves && lane.split.collided > 0.0;
    bool meets = !seeing && (event == EVENT_COLLIDED || event == EVENT_TOUCHED || (HAS_SURFACES && leaves) || splits);
    Rng numbers = numbers_of(meets, rng);
    vec3 leaving = direction_of(leaves, lane.path.direction);
    if (goes_on)
        go_on_across(v, seeing, lane);
    else if (seeing && event != EVENT_MOVING)
        end_shadow(v, event, lane);
    else if (event == EVENT_CUT)
        lane.todo = TODO_END;
#ifdef SURFACES
    else if (event == EVENT_LEFT && lane.reach < FAR)
        arrive_at_surface(v, lane, numbers, tally);
#endif
    else if (event == EVENT_LEFT)
        escape(v, leaving, lane, numbers);
    if (SPLITS) // in an `if` of its own, which kernels without it are compiled without
        if (splits && lane.split.collided > 0.0) {
            event = EVENT_COLLIDED;
            go_back(lane.walk, lane.split);
            lane.path.position += lane.walk.t * lane.path.direction;
            tally.real_collisions += 1u;
        }
    if (event == EVENT_COLLIDED && !seeing)
        collide(v, deposit, lane, numbers, tally);
    else if (event == EVENT_TOUCHED && !seeing)
        touch(v, deposit, lane, numbers);
    rng.draw = meets ? numbers.draw : rng.draw;
}

void turn(MediumParams v, inout Lane lane, inout Rng rng, inout Tally tally) {
    if (departs(lane.todo))
        depart(v, lane, rng, tally);
#ifdef SURFACES
    if (seeks(lane.todo))
        seek(v, lane, rng, tally);
#endif
    Spectrum deposit = to_spectrum(vec3(0.0));
    uint event = EVENT_MOVING;
    vec3 from = lane.path.position;
    if (is_under_way(lane.todo))
        event = track(v, lane, rng, deposit, tally);
    if (COUNTS_PASSING)
        if (is_particle(lane))
            count_flight(v, from, event, lane);
    arrive(v, event, deposit, lane, rng, tally);
    if (HAS_PARTICLES)
        if (lane.todo == TODO_END && lane.is_particle == 0u)
            emit(v, lane, rng);
}

#endif
