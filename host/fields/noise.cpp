#include "noise.h"

#include <cmath>
#include <fmt/format.h>

#include "error.h"

namespace vkvol {

namespace {

// Perlin's permutation of 0 to 255 (the reference implementation of "Improving Noise", SIGGRAPH 2002).
constexpr std::array<std::uint8_t, 256> permutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180,
};

constexpr double period = 256.0; // of the lattice's gradients, along each axis

} // namespace

const std::array<std::uint8_t, 256>& noise_permutation() {
    return permutation;
}

// Derivation of perlin_bound. At a point p of the unit cell the noise is the sum over the eight corners c of
// weight(c, p) * dot(gradient(c), p - c), where the weights are products of the fade curve and its complement, >= 0,
// and a gradient is one of (+-1, +-1, 0), (+-1, 0, +-1), (0, +-1, +-1). Over all choices the dot product is at most the
// sum of the two largest of |p - c|'s components, so the noise is at most
//     F(p) = sum over c of weight(c, p) * (sum - min of the components of |p - c|),
// and every value F(p) is reached by some choice of gradients; the least value is -F(p) since the gradients come in
// opposite pairs. F is unchanged by x -> 1 - x and by exchanging axes, so x <= y <= z <= 1/2 shows all of it. There the
// maximum is enclosed by branch and bound: within a box of half edges h around its centre q, F is at most
//     F(q) + sum over axes of h (1 + max fade'(t) |1 - 2 t| over the box),
// since the sum of the two largest components changes by at most 1 per unit of x, and fade' multiplies the difference
// between two averages of it, over the corners on either side, whose distances differ by |1 - 2 x|. The largest value
// found is 1.0363538, near (0.3553, 0.4815, 0.5); no box is left above 1.0364. tests/fields/noise_test.cpp repeats
// this.
shared::NoiseParams make_noise(const Noise& noise, glm::dvec3 origin) {
    shared::NoiseParams params{};
    double frequency = noise.frequency;
    for (int k = 0; k < noise.octaves; ++k, frequency *= noise.lacunarity) {
        if (!(frequency < 1e15))
            throw InputError(fmt::format("noise: octave {} has frequency {:.3g}, finer than any number can resolve; "
                                         "lower frequency, octaves or lacunarity",
                                         k + 1, frequency));
        const glm::dvec3 offset = frequency * origin;
        for (int axis = 0; axis < 3; ++axis)
            params.to_noise[k][axis] = static_cast<float>(std::remainder(offset[axis], period));
        params.to_noise[k].w = static_cast<float>(frequency);
    }
    params.octaves = static_cast<std::uint32_t>(noise.octaves);
    params.gain = static_cast<float>(noise.gain);
    for (std::uint32_t i = 0; i < permutation.size(); ++i)
        params.permutation[i / 16][static_cast<int>(i / 4 % 4)] |= std::uint32_t{permutation[i]} << 8 * (i % 4);
    return params;
}

double noise_bound(const Noise& noise) {
    double sum = 0.0, amplitude = 1.0;
    for (int k = 0; k < noise.octaves; ++k, amplitude *= noise.gain)
        sum += amplitude;
    return (1.0 + perlin_bound * sum) / 2.0;
}

} // namespace vkvol
