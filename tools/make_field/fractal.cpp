#include "fractal.h"

#include <algorithm>
#include <cmath>

namespace vkvol {
namespace {

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// Dot product of d with one of the twelve edge directions of a cube (four of them twice).
double gradient_dot(std::uint32_t hash, glm::dvec3 d) {
    const std::uint32_t h = hash >> 28;
    const double u = h < 8 ? d.x : d.y;
    const double v = h < 4 ? d.y : (h == 12 || h == 14 ? d.x : d.z);
    return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

} // namespace

std::uint32_t hash_of(glm::ivec3 cell, std::uint32_t seed) {
    // One multiply-xorshift round per word, ended with the finaliser of MurmurHash3.
    std::uint32_t h = seed * 0x9e3779b9u + 0x85ebca6bu;
    for (const int word : {cell.x, cell.y, cell.z}) {
        h = (h ^ std::uint32_t(word)) * 0xcc9e2d51u;
        h ^= h >> 15;
    }
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return h ^ (h >> 16);
}

glm::dvec3 RandomStream::on_sphere() {
    while (true) { // rejection needs no sine or cosine, whose last bits differ between maths libraries
        const double x = between(-1.0, 1.0), y = between(-1.0, 1.0), z = between(-1.0, 1.0);
        const double square = x * x + y * y + z * z;
        if (square > 1e-4 && square < 1.0)
            return glm::dvec3(x, y, z) / std::sqrt(square);
    }
}

double gradient_noise(glm::dvec3 p, std::uint32_t seed) {
    const glm::dvec3 base = glm::floor(p);
    const glm::ivec3 cell(base);
    const glm::dvec3 f = p - base;
    const auto corner = [&](int i, int j, int k) {
        return gradient_dot(hash_of(cell + glm::ivec3(i, j, k), seed), f - glm::dvec3(i, j, k));
    };
    const double u = fade(f.x), v = fade(f.y), w = fade(f.z);
    const auto edge = [&](int j, int k) { return glm::mix(corner(0, j, k), corner(1, j, k), u); };
    return glm::mix(glm::mix(edge(0, 0), edge(1, 0), v), glm::mix(edge(0, 1), edge(1, 1), v), w);
}

double fbm(glm::dvec3 p, int octaves, std::uint32_t seed) {
    double sum = 0.0, amplitude = 1.0;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * gradient_noise(p, seed + std::uint32_t(octave));
        // Turned as well as halved, so that the lattices of the octaves never line up.
        p = 2.0 * glm::dvec3(0.8 * p.x + 0.6 * p.z, p.y, 0.8 * p.z - 0.6 * p.x) + 17.31;
        amplitude *= 0.5;
    }
    return sum;
}

glm::dvec3 noise_vector(glm::dvec3 p, int octaves, std::uint32_t seed) {
    return {fbm(p, octaves, seed + 101u), fbm(p + 31.7, octaves, seed + 202u), fbm(p + 73.1, octaves, seed + 303u)};
}

double billow(glm::dvec3 p, std::uint32_t seed) {
    const glm::dvec3 base = glm::floor(p);
    const glm::ivec3 cell(base);
    const glm::dvec3 f = p - base;
    double nearest = 4.0;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
            for (int k = -1; k <= 1; ++k) {
                const std::uint32_t h = hash_of(cell + glm::ivec3(i, j, k), seed);
                const glm::dvec3 jitter(double(h & 1023u), double((h >> 10) & 1023u), double((h >> 20) & 1023u));
                const glm::dvec3 d = glm::dvec3(i, j, k) + (jitter + 0.5) / 1024.0 - f;
                nearest = std::min(nearest, glm::dot(d, d));
            }
    return std::max(0.0, 1.0 - nearest);
}

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace vkvol
