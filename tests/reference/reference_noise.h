// Perlin's improved noise ("Improving Noise", SIGGRAPH 2002) and the density made of it.
#pragma once

#include <glm/glm.hpp>

#include "scene.h"

namespace reference {

// 0 on the integer lattice.
double perlin(const glm::dvec3& p);

// No |perlin| is larger, whatever gradients meet at a cell. At the corner with offset d from the point, the gradients
// (+-1, +-1, 0), (+-1, 0, +-1), (0, +-1, +-1) give at most the sum of the two largest |d_i|; weighted by the faded
// corner weights and maximised over the cell that is 1.03635..., near the middles of the faces of a smaller cube: more
// than the 1 at the cell's middle.
constexpr double perlin_bound = 1.0364;

// max(0, (1 + sum over octaves k of gain^k perlin(frequency lacunarity^k x)) / 2)
double noise_density(const vkvol::Noise& noise, const glm::dvec3& x);
double noise_bound(const vkvol::Noise& noise); // never exceeded

} // namespace reference
