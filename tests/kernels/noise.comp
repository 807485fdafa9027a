#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "field/noise.glsl"
TEST_IO(NoiseInput, NoiseOutput)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    vec3 position = inputs[i].position;
    vec4 to_noise = frame.media[0].noise.to_noise[0];
    outputs[i].density = noise_density(frame.media[0].noise, 0u, position);
    outputs[i].octave = perlin(to_noise.w * position + to_noise.xyz);
}
