// hg_eval at (g, distance from the peak).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "phase/phase.glsl"
TEST_IO(vec2, float)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.lanes)
        outputs[i] = hg_eval(inputs[i].x, inputs[i].y);
}
