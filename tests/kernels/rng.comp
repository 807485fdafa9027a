#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "lib/rng.glsl"
TEST_IO(uvec4, RngOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    uvec4 key = inputs[i];
    Rng rng = Rng(key.x, key.y, key.z, key.w);
    RngOutput o;
    o.words = next_words(rng);
    o.u = to_uniform(o.words);
    o.tap = to_tap(o.words);
    o.exponential = to_exponential(o.words.x, o.words);
    o.of_key = to_exponential(key.x, key);
    o.event = to_event(o.words);
    o.event_of_key = to_event(key);
    o.draw = rng.draw;
    outputs[i] = o;
}
