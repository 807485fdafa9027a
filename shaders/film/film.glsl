// Adding samples to a film entry. A lane owns its pixel while it adds to it, so no atomics; they are added in
// order, so its sums have the same bits however the work was scheduled.
#ifndef FILM_GLSL
#define FILM_GLSL
#include "lib/tally.glsl"

// high + low += x. The rounding error of high + x (Knuth's TwoSum) goes into low, and what of low has grown into the
// digits of high goes back there (Dekker's FastTwoSum): else low in its turn would stall. `precise` forbids the compiler
// to undo it.
void add_compensated(inout vec3 high, inout vec3 low, vec3 x) {
    precise vec3 sum = high + x;
    precise vec3 part = sum - high;
    precise vec3 rest = low + ((high - (sum - part)) + (x - part));
    precise vec3 total = sum + rest;
    precise vec3 left = rest - (total - sum);
    high = total;
    low = left;
}

// To the sums of samples and of their squares.
void add_sample(inout vec3 sum, inout vec3 sum_low, inout vec3 square, inout vec3 square_low, vec3 x) {
    add_compensated(sum, sum_low, x);
    // x^2 = head^2 + 2 head tail + tail^2, each of them exact with 12 significant bits in the head: so that a variance
    // far below the mean is not lost in the rounding of squares.
    vec3 head = uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u);
    vec3 tail = x - head;
    add_compensated(square, square_low, head * head);
    add_compensated(square, square_low, 2.0 * head * tail);
    square_low += tail * tail;
}

// Radiance beyond this is as good as infinite: 2^32 squares of it are still a float.
const float MOST_RADIANCE = 281474976710656.0; // 2^48

// A sample that is not finite is dropped and counted, the first of them with its place in the picture and number.
void film_add(inout FilmPixel pixel, vec3 radiance, uint place, uint sample_index, inout Tally tally) {
    tally.paths += 1u;
    // By its bits, since compilers may take it that nothing is NaN: that is above infinity.
    uvec3 size = floatBitsToUint(radiance) & 0x7fffffffu;
    if (any(greaterThan(size, uvec3(floatBitsToUint(MOST_RADIANCE))))) {
        if (tally.non_finite == 0u) {
            tally.dropped_place = place;
            tally.dropped_sample = sample_index;
        }
        tally.non_finite += 1u;
        return;
    }
    add_sample(pixel.sum, pixel.sum_low, pixel.square, pixel.square_low, radiance);
    pixel.count += 1u;
}

#endif
