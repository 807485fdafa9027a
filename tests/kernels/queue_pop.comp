// Each invocation takes up to push.budget items and notes them; with push.places it puts each back into the same queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "lib/queue.glsl"
TEST_IO(uint, uint)

void main() {
    uint i = gl_GlobalInvocationID.x;
    for (uint k = 0u; k < push.budget; ++k) {
        uint slot;
        bool found = pop_item(push.queue, slot);
        if (!found)
            continue; // asking again past the end must find nothing either
        outputs[i * push.budget + k] = slot;
        if (push.places != 0u)
            push_item(push.queue, slot);
    }
}
