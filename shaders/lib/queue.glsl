// Queues of slot numbers, rings in one buffer. Between two passes that consume a queue a slot is pushed to it at most
// once, and it can hold every slot when such a pass begins: so twice as many places as slots are enough. Should an item
// find no place all the same, it is dropped and counted, and the host gives up.
#ifndef QUEUE_GLSL
#define QUEUE_GLSL
#include "lib/buffers.glsl"

void push_item(uint queue, uint slot) {
    uint position = atomicAdd(queues[queue].tail, 1u);
    if (position - queues[queue].base < frame.queue_capacity)
        queue_items[queue * frame.queue_capacity + (position & (frame.queue_capacity - 1u))] = slot;
    else
        atomicAdd(counters.queue_overflows, 1u);
}

// False if nothing is left of what was there when the pass began.
bool pop_item(uint queue, out uint slot) {
    uint position = atomicAdd(queues[queue].head, 1u);
    bool found = int(queues[queue].limit - position) > 0;
    slot = found ? queue_items[queue * frame.queue_capacity + (position & (frame.queue_capacity - 1u))] : 0u;
    return found;
}

#endif
