// Light that particles bring to whatever pixel sees them. Splats are summed as whole numbers of 64 bits, in two words, so that it does
// not matter for the bits who comes first; what a number cannot hold is rounded at random, so that on average nothing is lost. There is
// a picture of splats for each sample of a batch, and when the batch is over they are the pixels' samples: see collect.comp.
#ifndef SPLATS_GLSL
#define SPLATS_GLSL
#include "film/film.glsl"
#include "lib/rng.glsl"

const float WORD = 4294967296.0;
const float MOST_SPLAT = 1.0e18; // some of which are below 2^63

// SPLAT_WORDS: red's low and high one, and so on. Behind the last pixel is the picture's sum, of three words per channel, in the
// room of two pixels.
uint splat_pixels() {
    return frame.crop_width * frame.crop_height;
}
uint splat_place(uint pixel, uint sample_index) {
    return uint(SPLAT_WORDS) * ((sample_index - push.sample_begin) * (splat_pixels() + 2u) + pixel);
}

void add_whole(uint at, float x) {
    if (x == 0.0)
        return;
    float size = abs(x);
    uint high = uint(size * (1.0 / WORD)); // whole: a power of 2
    uint low = uint(size - WORD * float(high));
    if (x < 0.0) { // of two's complement
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    uint before = atomicAdd(splats[at], low);
    high += before + low < before ? 1u : 0u;
    if (high != 0u)
        atomicAdd(splats[at + 1u], high);
}

// What is not finite, or more than the numbers hold, is dropped, and counted.
void splat(uint pixel, uint place, uint sample_index, vec3 light) {
    vec3 x = light / frame.particles.unit;
    uvec3 magnitude = floatBitsToUint(x) & 0x7fffffffu; // of NaN above infinity, see film_add
    if (any(greaterThan(magnitude, uvec3(floatBitsToUint(MOST_SPLAT))))) {
        count_dropped(1u, place, sample_index);
        return;
    }
    vec3 u = to_uniform(pcg4d(uvec4(floatBitsToUint(x), place ^ sample_index))).xyz;
    x = mix(x, floor(x + u), lessThan(abs(x), vec3(8388608.0)));
    uint at = splat_place(pixel, sample_index);
    add_whole(at, x.x);
    add_whole(at + 2u, x.y);
    add_whole(at + 4u, x.z);
}

// Adds to a word, and says what it carries.
uint add_word(uint at, uint x) {
    if (x == 0u)
        return 0u;
    uint before = atomicAdd(splats[at], x);
    return before + x < before ? 1u : 0u;
}

// A pixel's number of 64 bits to the picture's of 96, which holds a million of the largest.
void add_to_sum(uint at, uint sum) {
    [[unroll]] for (uint c = 0u; c < 3u; ++c) {
        uint low = splats[at + 2u * c], high = splats[at + 2u * c + 1u];
        uint into = sum + 3u * c;
        uint carried = add_word(into + 1u, add_word(into, low));
        carried += add_word(into + 1u, high);
        add_word(into + 2u, carried + (int(high) < 0 ? 0xffffffffu : 0u));
    }
}

// Value of a number of 96 bits, in units; taken from the number without its sign, which is rounded but once.
float whole(uint at) {
    uvec3 words = uvec3(splats[at], splats[at + 1u], splats[at + 2u]);
    bool negative = int(words.z) < 0;
    if (negative) {
        words = ~words + uvec3(1u, 0u, 0u);
        words.y += words.x == 0u ? 1u : 0u;
        words.z += (words.x | words.y) == 0u ? 1u : 0u;
    }
    float size = (float(words.z) * WORD + float(words.y)) * WORD + float(words.x);
    return negative ? -size : size;
}

vec3 splatted_sum(uint at) {
    return frame.particles.unit * vec3(whole(at), whole(at + 3u), whole(at + 6u));
}

vec3 splatted(uint at) {
    vec3 low = vec3(splats[at], splats[at + 2u], splats[at + 4u]);
    vec3 high = vec3(int(splats[at + 1u]), int(splats[at + 3u]), int(splats[at + 5u]));
    return frame.particles.unit * (WORD * high + low);
}

// A path is over.
void film_or_splats(inout FilmPixel sums, vec3 radiance, uint pixel, uint place, uint sample_index, inout Tally tally) {
    if (HAS_PARTICLES) {
        if (!COUNTS)
            splat(pixel, place, sample_index, radiance);
        tally.paths += 1u;
    } else {
        film_add(sums, radiance, place, sample_index, tally);
    }
}

#endif
