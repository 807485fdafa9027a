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
    vec3 from = inputs[i].position, travel = vec3(0.0, 0.0, -1.0);
    Rng rng = Rng(inputs[i].key, 0u, 0u, frame.seed), again = rng;
    uvec4 words = next_words(rng);
    float chance;
    uint index = choose_light(lit_point(from, inputs[i].on_surface != 0u, inputs[i].normal), words, rng, chance);
    LightSample drawn = over_density(sample_light(frame.media[0], light_at(index), from, travel, words, rng), chance);
    LightRow light;
    if (inputs[i].on_surface == 0u)
        drawn = look_for_light(frame.media[0], from, travel, again, light);
    outputs[i] = LookOutput(index, chance, drawn.direction, drawn.distance, drawn.light, drawn.pdf);
}
