// Add a finished path to its pixel and free the slot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/pass.glsl"

#include "../include/film.glsl"
#include "../include/queue.glsl"

void main() {
    uint slot;
    if (!pop_item(QUEUE_ACCUMULATE, slot))
        return;
    uint pixel = paths[slot].pixel;
    FilmPixel entry = film[pixel];
    film_add(entry, paths[slot].radiance, pixel, paths[slot].sample_index);
    film[pixel] = entry;
    atomicAdd(counters.paths, 1u);
    push_item(QUEUE_GENERATE, slot);
}
