// Looks toward the lights of a table, from given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "lights/table.glsl"
TEST_IO(LookInput, LookOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    Rng rng = Rng(inputs[i].key, 0u, 0u, frame.seed);
    LightSample drawn = look_for_light(inputs[i].position, rng);
    Rng again = Rng(inputs[i].key, 0u, 0u, frame.seed);
    outputs[i] = LookOutput(choose_light(next_words(again)), drawn.direction, drawn.distance, drawn.light, drawn.pdf);
}
