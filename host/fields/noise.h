// Procedural density: what noise.glsl needs, and how large the density can become.
#pragma once

#include <array>
#include <cstdint>

#include "scene.h"
#include "shared/frame.h"

namespace vkvol {

// Perlin's permutation of 0 to 255.
const std::array<std::uint8_t, 256>& noise_permutation();

// The largest value of one octave, over all points and all choices of the lattice's gradients; see noise.cpp.
constexpr double perlin_bound = 1.0364;

// `origin`: of render space, in world coordinates.
shared::NoiseParams make_noise(const Noise& noise, glm::dvec3 origin);

// No density of this noise is larger.
double noise_bound(const Noise& noise);

} // namespace vkvol
