#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "lib/queue.glsl"
TEST_IO(uint, uint)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.lanes)
        push_item(push.queue, inputs[i]);
}
