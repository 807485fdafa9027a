// The fused schedule: give each free slot the next pixel on the work list.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "sensors/camera.glsl"
#include "lib/path_words.glsl"
#include "lib/queue.glsl"

// The next pixel of the work list, or NO_PIXEL.
uint take_pixel() {
    uint index = atomicAdd(counters.next_work, 1u);
    return index < min(push.work_end, counters.work_count) ? work[index] : NO_PIXEL;
}

void main() {
    uint slot;
    if (!pop_item(QUEUE_GENERATE, slot))
        return;
    uint pixel = take_pixel();
    if (pixel == NO_PIXEL)
        return; // no work left: the slot rests until the next batch
    PATH_WORD(slot, PATH_PIXEL) = pixel;
    PATH_WORD(slot, PATH_PLACE) = place_of(pixel);
    push_item(QUEUE_TRACK, slot);
}
