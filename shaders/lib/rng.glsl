// Counter-based random numbers, keyed by (pixel, sample, draw): no state but the draw counter, so a result does not
// depend on scheduling. This comment is the specification; the CPU reference is written from it.
//
//   key   = (x | y << 16, sample, draw, seed)         x, y: pixel of the picture (not of the crop), 16 bits each
//   words = pcg4d(key)                                 Jarzynski & Olano, "Hash Functions for GPU Rendering", 2020
//   u_i   = (words_i >> 8) * 2^-24                     in [0, 1)
//   event = (words_y >> 8) * 2^-24 + (words_z & 255) * 2^-32, and below 1: what happens once in 10^6 times does so as often as
//           it should
//   tap   = ((words_z >> 8), (words_w >> 8), low bytes of m_y, m_z, m_x as one 24-bit number) * 2^-24, m = words ^ words >> 16:
//           low bytes alone know nothing of the key's upper ones, so that of rows 256 apart they are the same
//   media = event of pcg4d(words): of several that are met, which
//   e_i   = -log(1 - U), U = (words_i + r * 2^-24) * 2^-32, r: low bytes of words_w, words_y, words_x as one number.
//           At most 38.82; of steps of 2^-48 near 0: a medium thinner than 2^-24 is hit as often as it should be.
//
// Order of draws along a path; each draw yields four words. `select` is tap.z: it chooses a colour channel.
//   camera                 x, y: position in the pixel; e_z: first free flight; select
//   tentative collision    e_x: next distance; event: which, or roulette; tap: stochastic filtering; media
//   step of a march        x: position in the step; y: roulette of a march through the medium
//   emission along a step  x: position in the step; after the step's own draw; none in an empty cell, or for a closed form
//   shadow ray             e_x: first distance; y, z, select: telescoping's level, offset and residue; none is drawn
//                          for one known in closed form
//   light from the cache   x: whether a shadow ray corrects it; after the choice of a light, where there is one
//   choice of a light      x, y: which; z, w: where on it; select: whether by the phase function instead. Then, down a tree,
//                          a draw for each three levels, x, y, z, and w of the first: whether by halves; of a map of the sky
//                          x, y: row; z, w: column; of a surface of any shape x, y: which piece
//   look along a flight    y: the distance; tap: its density. Then the light's own draw, as of a choice. The flight takes a
//                          draw of its own after that
//   light before a sensor  of flux: a choice of a light, behind the camera's draw; then as after a lamp before the camera
//   lamp before the camera w of the camera's draw: which of those that the ray meets. After its shadow ray the first
//                          flight takes a draw of its own, e_z as from the camera's
//   particle's beginning   x, y: what it comes from; z, w: where; then x, y: direction; z: of three where, or which side. Of a map of the sky
//                          and of what glows one more draw. A draw of the first flight as the camera's
//   particle's look        toward the sensor: x, y: where on the lens; z, w: which of the pixels to which it counts
//   walk among facets      after a surface is met, and again after the draw with which the path departs: the key of the walk's own
//                          numbers, which are hashes of (words_x, words_y, words_z + n, words_w)
//   lamps shown            by a mirror, glass or a vertex before surfaces, behind the draw of the departure: w: which of them; taken
//                          whether one is in the way or not
//   split first flight     at tentative collisions, event: whether that one is picked. At its end a draw, event: whether the path goes
//                          on from there, or, if what was left has collided, from which of the two
//   scattering             e_x: next free flight; y, z: phase function; w: roulette; select
//   scattering, a surface  y, z, x: the BSDF; w, in parts: which side's normal, and the roulettes
// Where there are surfaces each flight and each shadow ray takes a draw of its own once its end is known: e_x and select. Those of
// the camera and of scattering are not used then.
#ifndef RNG_GLSL
#define RNG_GLSL

struct Rng {
    uint pixel; // x | y << 16
    uint sample_index;
    uint draw; // the next draw
    uint seed;
};

uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

uvec4 next_words(inout Rng rng) {
    uvec4 words = pcg4d(uvec4(rng.pixel, rng.sample_index, rng.draw, rng.seed));
    rng.draw += 1u;
    return words;
}

// [0, 1), a multiple of 2^-24
vec4 to_uniform(uvec4 words) {
    return vec4(words >> 8u) * 5.9604644775390625e-8;
}

float to_event(uvec4 words) {
    return min((float(words.y >> 8u) + float(words.z & 255u) * 0.00390625) * 5.9604644775390625e-8, 0.99999994);
}

// Three numbers in [0, 1) that are independent of the x and y of to_uniform(words).
vec3 to_tap(uvec4 words) {
    uvec4 mixed = words ^ (words >> 16u);
    uint low_bytes = ((mixed.y & 255u) << 16u) | ((mixed.z & 255u) << 8u) | (mixed.x & 255u);
    return vec3(uvec3(words.z >> 8u, words.w >> 8u, low_bytes)) * 5.9604644775390625e-8;
}

// Unit exponential variate from one of the words of a draw. 1 - U is formed from the integer's complement, so it has all
// digits where U is near 1. Where U is small 1 - U would keep no more of it than multiples of 2^-24, and Vulkan lets
// log err by 2^-21 there: the series of -log(1 - U) instead, whose next term is U^4 / 5 < 2^-26 of it.
float to_exponential(uint word, uvec4 words) {
    const uint small = 1u << 26u; // U < 2^-6
    uint rest = (words.w & 255u) << 16u | (words.y & 255u) << 8u | (words.x & 255u);
    float part = float(rest) * 5.9604644775390625e-8;
    float U = (float(word) + part) * 2.3283064365386963e-10;
    float series = U * (1.0 + U * (0.5 + U * (1.0 / 3.0 + U * 0.25)));
    return word < small ? series : -log((float(0u - word) - part) * 2.3283064365386963e-10);
}

#endif
