// Fix what the pass that consumes a queue will see, and turn it into that pass's dispatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

void main() {
    if (gl_GlobalInvocationID.x != 0u)
        return;
    QueueHeader header = queues[push.queue];
    if (int(header.head - header.limit) > 0) // lanes that found nothing ran past the end
        header.head = header.limit;
    header.base = header.head;
    header.limit = header.tail;
    uint items = header.limit - header.head;
    if (push.before != push.queue)
        items += queues[push.before].limit - queues[push.before].head;
    counters.queued[push.queue] += items;
    uint lanes = min(items, push.lanes);
    header.groups_x = (lanes + WORKGROUP_SIZE - 1u) / WORKGROUP_SIZE;
    queues[push.queue] = header;
}
