// Particles: when all of a batch are done, the splats of each of its samples are those samples of the pixels, which are added in their
// order. Then, once more, those of the picture's sum, whose pixels have parts of the same particles: behind the film's last pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/pass.glsl"

#include "film/splats.glsl"

void main() {
    uint pixel = push.pixel_begin + gl_GlobalInvocationID.x;
    if (pixel >= push.pixel_end)
        return;
    bool is_sum = pixel == splat_pixels();
    FilmPixel sums = film[pixel];
    for (uint i = push.sample_begin; i < push.sample_end; ++i) {
        uint at = splat_place(pixel, i);
        vec3 light = is_sum ? splatted_sum(at) : splatted(at);
        add_sample(sums.sum, sums.sum_low, sums.square, sums.square_low, light);
        sums.count += 1u;
        if (!is_sum)
            add_to_sum(at, splat_place(splat_pixels(), i));
    }
    film[pixel] = sums;
}
