// Directions drawn from the phase function that the scene has, and its values at them and at given ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FULL
#include "kernel.glsl"

#include "phase/phase.glsl"
TEST_IO(ScatterInput, ScatterOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    MediumParams v = frame.media[0];
    vec3 before = inputs[i].before;
    ScatterOutput o;
    o.drawn = phase_sample(v, before, inputs[i].u);
    o.drawn_eval = phase_eval(v, before, o.drawn);
    o.at = turned(before, inputs[i].x, inputs[i].u.y);
    o.at_eval = phase_eval(v, before, o.at);
    o.at_eval_twice = PHASE_HAS_TWICE ? phase_eval_twice(v, before, o.at) : 0.0;
    outputs[i] = o;
}
