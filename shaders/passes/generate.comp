// The staged schedule: free slots get the next samples of the work list, and their paths begin, at the camera. All samples
// of a pixel have consecutive numbers in that list, and a place among those that wait to be added to the film; while
// another pixel has it, they wait. The earliest sample under way never does, so neither do all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "lib/queue.glsl"
#include "stages/generate.glsl"
#include "stages/send.glsl"

// The slot's next sample: one it had been given before, or the next of the work list. False if none is left.
bool has_sample(uint slot) {
    if (PATH_WORD(slot, PATH_TODO) == TODO_BEGIN)
        return true;
    uint number = atomicAdd(counters.next_work, 1u);
    uint samples = push.sample_end - push.sample_begin;
    uint index = number / samples;
    if (number >= push.work_end || index >= counters.work_count)
        return false;
    PATH_WORD(slot, PATH_TODO) = TODO_BEGIN;
    PATH_WORD(slot, PATH_PIXEL) = index;
    PATH_WORD(slot, PATH_SAMPLE) = push.sample_begin + number % samples;
    return true;
}

void main() {
    uint slot;
    if (!pop_item(QUEUE_GENERATE, slot) || !has_sample(slot))
        return; // no work left: the slot rests until the next batch
    uint index = PATH_WORD(slot, PATH_PIXEL);
    if (sample_places[index % push.places].tenants != index / push.places) {
        push_item(QUEUE_GENERATE, slot);
        return;
    }
    Lane lane;
    Rng rng;
    lane.path.place = place_of(work[index]);
    lane.path.sample_index = PATH_WORD(slot, PATH_SAMPLE);
    lane.path.pixel = index;
    lane.record = waiting_place(lane.path);
    generate(frame.media[0], lane, rng);
    lay_aside(slot, index, rng, lane, false);
    push_item(SHADOW_RAYS_WALK && lane.todo == TODO_LOOK ? QUEUE_SHADOW : QUEUE_TRACK, slot);
}
