// Directions drawn from the map of the sky by a key, and what the map is at them and at given ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FULL
#include "kernel.glsl"

#include "lights/sky.glsl"
TEST_IO(SkyInput, SkyOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    Rng rng = Rng(inputs[i].key, 0u, 0u, frame.seed);
    vec2 u = to_uniform(next_words(rng)).xy;
    LightSample drawn = sample_sky(u, rng);
    vec2 place = sky_place(drawn.direction), given = sky_place(inputs[i].direction);
    float breadth;
    vec3 again = sky_direction(given, breadth);
    SkyValue there = sky_toward(drawn.direction, place), seen = sky_toward(inputs[i].direction, given);
    outputs[i] = SkyOutput(drawn.direction, drawn.light, drawn.pdf, there.radiance, there.pdf, seen.radiance, seen.pdf, again);
}
