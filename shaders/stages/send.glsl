// The staged schedule: where a path goes from here.
#ifndef STAGE_SEND_GLSL
#define STAGE_SEND_GLSL
#include "lib/queue.glsl"
#include "lib/trace.glsl"
#include "sensors/camera.glsl"
#include "stages/laid_aside.glsl"

// Where its sample will wait.
uint waiting_place(PathState path) {
    uint samples = push.sample_end - push.sample_begin;
    return path.pixel % push.places * samples + path.sample_index - push.sample_begin;
}

// The path's sample waits for those before it to be added to the film.
void finish(uint slot, Lane lane) {
    trace(TRACE_END, lane, lane.path.position, lane.path.direction);
    uint i = waiting_place(lane.path);
    uvec3 words = floatBitsToUint(measured(lane.path.radiance));
    words.x = words.x == NO_SAMPLE ? 0x7fc00000u : words.x; // another NaN: it is there
    waiting_samples[i] = words;
    PATH_WORD(slot, PATH_TODO) = TODO_TAKE;
    push_item(QUEUE_GENERATE, slot);
}

// Where flights rest while shadow rays are sent amid them, paths come to a pass amid a segment; else only those that are
// laid aside do, once per lane, and the loop over turns need not know how: software drivers would pay for it every time.
const bool COMES_AMID = NEE == NEE_TENTATIVE;

// To another pass.
void send(uint slot, Rng rng, inout Lane lane) {
    if (lane.todo == TODO_END) {
        finish(slot, lane);
    } else {
        lay_aside(slot, lane.path.pixel, rng, lane, COMES_AMID);
        push_item(SHADOW_RAYS_WALK && lane.todo == TODO_LOOK ? QUEUE_SHADOW : QUEUE_TRACK, slot);
    }
    lane.todo = TODO_TAKE;
}

#endif
