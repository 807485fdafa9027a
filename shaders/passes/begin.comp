// Begin a batch: every slot is free, and no work is listed yet.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "lib/path_words.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot < push.places)
        sample_places[slot] = SamplePlace(0u, 0u);
    if (slot < push.places * (push.sample_end - push.sample_begin))
        waiting_samples[slot].x = NO_SAMPLE;
    if (slot >= frame.slots)
        return;
    PATH_WORD(slot, PATH_TODO) = TODO_TAKE;
    queue_items[QUEUE_GENERATE * frame.queue_capacity + slot] = slot;
    if (slot == 0u) {
        for (uint queue = 0u; queue < QUEUE_COUNT; ++queue)
            queues[queue] = QueueHeader(0u, queue == QUEUE_GENERATE ? frame.slots : 0u, 0u, 0u, 0u, 1u, 1u);
        counters.next_work = 0u;
        counters.work_count = 0u;
    }
}
