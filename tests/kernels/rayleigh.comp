// Rayleigh's phase function at a cosine, after one and after two scatterings, and the cosine drawn for u.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "phase/phase.glsl"
TEST_IO(vec3, vec3)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.lanes)
        outputs[i] = vec3(rayleigh_eval(inputs[i].z, inputs[i].x), rayleigh_eval_twice(inputs[i].z, inputs[i].x),
                          rayleigh_sample_cosine(inputs[i].z, inputs[i].y));
}
