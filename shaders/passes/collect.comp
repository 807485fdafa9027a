// Particles: when all of a batch are done, the splats of each of its samples are those samples of the pixels, which are added in their
// order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "film/splats.glsl"

void main() {
    uint pixel = push.pixel_begin + gl_GlobalInvocationID.x;
    if (pixel >= push.pixel_end)
        return;
    FilmPixel sums = film[pixel];
    for (uint i = push.sample_begin; i < push.sample_end; ++i) {
        add_sample(sums.sum, sums.sum_low, sums.square, sums.square_low, splatted(splat_place(pixel, i)));
        sums.count += 1u;
    }
    film[pixel] = sums;
}
