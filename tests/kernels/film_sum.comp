// Adds push.budget samples to each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

#include "film/film.glsl"
#include "lib/rng.glsl"
TEST_IO(FilmInput, FilmPixel)

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.lanes)
        return;
    FilmPixel pixel = inputs[i].pixel;
    Tally tally = NOTHING_SEEN;
    Rng rng = Rng(i, 0u, inputs[i].first, 0u);
    for (uint k = 0u; k < push.budget; ++k) {
        float scale = inputs[i].random != 0u ? to_uniform(next_words(rng)).x : 1.0;
        film_add(pixel, scale * inputs[i].radiance, 100u + i, k, tally);
    }
    add_film_tally(tally);
    outputs[i] = pixel;
}
