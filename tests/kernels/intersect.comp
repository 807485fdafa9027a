#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "shapes/shape.glsl"
TEST_IO(ShapeInput, ShapeOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    Ray ray = Ray(inputs[i].origin, inputs[i].direction);
    ShapeOutput o;
    o.box_hit = intersect_box(ray, inputs[i].low, inputs[i].high, o.box) ? 1u : 0u;
    o.ball_hit = intersect_unit_ball(ray, o.ball) ? 1u : 0u;
    outputs[i] = o;
}
