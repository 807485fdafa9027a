// Noise for sculpting: integer hashes and polynomials only, so that every machine makes the same bits.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace vkvol {

std::uint32_t hash_of(glm::ivec3 cell, std::uint32_t seed);

// A short stream of random numbers for placing things.
class RandomStream {
public:
    explicit RandomStream(std::uint32_t seed) : seed_(seed) {}

    double uniform() { return double(hash_of({count_++, 0, 0}, seed_) >> 8) / double(1 << 24); } // [0, 1)
    double between(double low, double high) { return low + (high - low) * uniform(); }
    glm::dvec3 on_sphere(); // uniform unit vector

private:
    std::uint32_t seed_;
    int count_ = 0;
};

// Perlin's gradient noise (2002) with a quintic fade: about [-1, 1], zero at lattice points.
double gradient_noise(glm::dvec3 p, std::uint32_t seed);

// Sum of `octaves` gradient noises, each of twice the frequency and half the amplitude of the one before.
double fbm(glm::dvec3 p, int octaves, std::uint32_t seed);

// Three independent noises: a smooth displacement of space.
glm::dvec3 noise_vector(glm::dvec3 p, int octaves, std::uint32_t seed);

// 1 - F1^2 of Worley's cellular noise (1996): round convex bumps of width about 1 that meet in creases, in [0, 1].
double billow(glm::dvec3 p, std::uint32_t seed);

// 0 below `low`, 1 above `high`, a cubic between.
double smooth_step(double low, double high, double x);

} // namespace vkvol
