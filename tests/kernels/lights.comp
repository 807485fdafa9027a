// Looks toward the lights of a table, from given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FULL
#include "kernel.glsl"

#include "lights/table.glsl"
TEST_IO(LookInput, LookOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    Rng rng = Rng(inputs[i].key, 0u, 0u, frame.seed);
    LightRow light;
    LightSample drawn = look_for_light(frame.media[0], inputs[i].position, vec3(0.0, 0.0, -1.0), rng, light);
    Rng again = Rng(inputs[i].key, 0u, 0u, frame.seed);
    uvec4 words = next_words(again);
    float chance;
    uint index = choose_light(inputs[i].position, words, again, chance);
    outputs[i] = LookOutput(index, chance, drawn.direction, drawn.distance, drawn.light, drawn.pdf);
}
