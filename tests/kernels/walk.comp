// Every step of a walk over the majorant cells, up to push.step_limit of them per ray. Rays are in medium space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "shapes/segment.glsl"
TEST_IO(RayInput, WalkStep)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    MediumParams v = frame.media[0];
    Ray ray = Ray(inputs[i].origin, inputs[i].direction);
    vec2 t;
    uint event = medium_interval(v, ray, t) ? EVENT_MOVING : EVENT_LEFT;
    Walk w;
    w.tau = inputs[i].e > 0.0 ? inputs[i].e : 1.0e4;
    begin_part(v, ray, event == EVENT_MOVING ? t : vec2(0.0), false, w);
    for (uint k = 0u; k < push.step_limit; ++k) {
        bool moving = event == EVENT_MOVING;
        WalkStep record = WalkStep(w.cell, 0.0, w.sigma_maj, 0.0, event);
        event = moving ? advance(v, false, w) : event;
        record.t = t.x + w.t;
        record.tau = w.tau;
        record.event = moving ? event : NO_PIXEL;
        outputs[i * push.step_limit + k] = record;
    }
}
