// Counter-based random numbers, written from the specification in the comment of shaders/lib/rng.glsl:
// a hash of (pixel, sample, draw, seed), so that a path can be repeated alone.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace reference {

// Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
inline std::array<std::uint32_t, 4> pcg4d(std::array<std::uint32_t, 4> key) {
    auto [x, y, z, w] = key;
    for (std::uint32_t* v : {&x, &y, &z, &w})
        *v = *v * 1664525u + 1013904223u;
    const auto mix = [&] {
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
    };
    mix();
    for (std::uint32_t* v : {&x, &y, &z, &w})
        *v ^= *v >> 16;
    mix();
    return {x, y, z, w};
}

// The four words of one draw.
struct Draw {
    std::array<std::uint32_t, 4> words;

    double uniform(int i) const { return (words[i] >> 8) * 0x1p-24; } // [0, 1)
    double event() const { return uniform(1) + (words[2] & 255u) * 0x1p-32; }
    double x() const { return uniform(0); }
    double y() const { return uniform(1); }
    double z() const { return uniform(2); }
    double w() const { return uniform(3); }

    // Three more numbers in [0, 1) that are independent of x() and y().
    glm::dvec3 tap() const {
        const auto low_byte = [this](int i) { return (words[i] ^ words[i] >> 16) & 255u; };
        const std::uint32_t low_bytes = low_byte(1) << 16 | low_byte(2) << 8 | low_byte(0);
        return glm::dvec3(words[2] >> 8, words[3] >> 8, low_bytes) * 0x1p-24;
    }

    // Unit exponential variate from word i.
    double exponential(int i) const {
        const std::uint32_t rest = (words[3] & 255u) << 16 | (words[1] & 255u) << 8 | (words[0] & 255u);
        return -std::log1p(-(words[i] + rest * 0x1p-24) * 0x1p-32);
    }

    // One more number in [0, 1), independent of x() to w().
    double select() const { return tap().z; }
};

struct Rng {
    std::uint32_t pixel; // x | y << 16, of the picture
    std::uint32_t sample;
    std::uint32_t seed;
    std::uint32_t draw = 0; // the next draw

    Draw next() { return {pcg4d({pixel, sample, draw++, seed})}; }
};

} // namespace reference
