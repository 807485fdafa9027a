#include "reference_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace reference {

namespace {

constexpr std::array<int, 256> permutation{
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
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

int permute(int i) {
    return permutation[i & 255];
}

int hash(const glm::ivec3& lattice) {
    return permute(permute(permute(lattice.x) + lattice.y) + lattice.z);
}

// The 12 directions to the middles of a cube's edges; four of them twice, to make 16.
glm::dvec3 gradient(int hash) {
    static const std::array<glm::dvec3, 16> directions{{{1, 1, 0},
                                                        {-1, 1, 0},
                                                        {1, -1, 0},
                                                        {-1, -1, 0},
                                                        {1, 0, 1},
                                                        {-1, 0, 1},
                                                        {1, 0, -1},
                                                        {-1, 0, -1},
                                                        {0, 1, 1},
                                                        {0, -1, 1},
                                                        {0, 1, -1},
                                                        {0, -1, -1},
                                                        {1, 1, 0},
                                                        {0, -1, 1},
                                                        {-1, 1, 0},
                                                        {0, -1, -1}}};
    return directions[hash & 15];
}

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

} // namespace

double perlin(const glm::dvec3& p) {
    const glm::dvec3 base = glm::floor(p), f = p - base;
    const glm::ivec3 lattice(base - 256.0 * glm::floor(base / 256.0)); // the noise repeats; no integer holds far points
    const glm::dvec3 weight(fade(f.x), fade(f.y), fade(f.z));
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 w = glm::mix(1.0 - weight, weight, glm::dvec3(c));
        sum += w.x * w.y * w.z * glm::dot(gradient(hash(lattice + c)), f - glm::dvec3(c));
    }
    return sum;
}

double noise_density(const vkvol::Noise& noise, const glm::dvec3& x) {
    double fbm = 0.0, frequency = noise.frequency, amplitude = 1.0;
    for (int octave = 0; octave < noise.octaves; ++octave) {
        fbm += amplitude * perlin(frequency * x);
        frequency *= noise.lacunarity;
        amplitude *= noise.gain;
    }
    return std::max(0.0, 0.5 * (1.0 + fbm));
}

double noise_bound(const vkvol::Noise& noise) {
    double sum = 0.0, amplitude = 1.0;
    for (int octave = 0; octave < noise.octaves; ++octave) {
        sum += amplitude;
        amplitude *= noise.gain;
    }
    return 0.5 * (1.0 + perlin_bound * sum);
}

} // namespace reference
