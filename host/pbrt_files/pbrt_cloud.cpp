#include "pbrt_cloud.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace vkvol {

namespace {

// The gradient of a lattice point, pbrt's choice of those by Perlin, times where p is from there.
double toward(int x, int y, int z, const glm::dvec3& p) {
    const auto& permutation = noise_permutation();
    const auto next = [&](int at) { return int(permutation[std::size_t(at) & 255u]); };
    const int h = next(next(next(x) + y) + z) & 15;
    const bool is_first = h < 8 || h == 12 || h == 13, is_second = h < 4 || h == 12 || h == 13;
    const double u = is_first ? p.x : p.y, v = is_second ? p.y : p.z;
    return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

double fade(double t) {
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

double noise(const glm::dvec3& p) {
    const glm::dvec3 cell = glm::floor(p), in = p - cell;
    const auto corner = [](double x) { return int(std::remainder(x, 256.0) + 256.0) & 255; };
    const int x = corner(cell.x), y = corner(cell.y), z = corner(cell.z);
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 at(c & 1, c >> 1 & 1, c >> 2);
        double weight = 1.0;
        for (int axis = 0; axis < 3; ++axis)
            weight *= at[axis] == 1 ? fade(in[axis]) : 1.0 - fade(in[axis]);
        sum += weight * toward(x + at.x, y + at.y, z + at.z, in - glm::dvec3(at));
    }
    return sum;
}

// As pbrt differentiates it.
glm::dvec3 slope(const glm::dvec3& p) {
    constexpr double delta = 0.01;
    const double here = noise(p);
    return glm::dvec3(noise(p + glm::dvec3(delta, 0, 0)) - here, noise(p + glm::dvec3(0, delta, 0)) - here,
                      noise(p + glm::dvec3(0, 0, delta)) - here) /
           delta;
}

} // namespace

double PbrtCloud::at(const glm::dvec3& p) const {
    glm::dvec3 place = frequency * p;
    double amplitude = 0.05 * wispiness, scale = 10.0;
    for (int k = 0; k < 2 && wispiness > 0.0; ++k, amplitude *= 0.5, scale *= 1.99)
        place += amplitude * slope(scale * place);
    double sum = 0.0;
    amplitude = 0.5;
    scale = 1.0;
    for (int k = 0; k < 5; ++k, amplitude *= 0.5, scale *= 1.99)
        sum += amplitude * noise(scale * place);
    const double cloud = std::clamp((1.0 - p.y) * 4.5 * density * sum, 0.0, 1.0);
    return std::clamp(cloud + 2.0 * std::max(0.0, 0.5 - p.y), 0.0, 1.0);
}

} // namespace vkvol
