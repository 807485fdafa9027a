// A layer of broken cloud in haze, for light to fall through the gaps. Lengths are world units; the box is 96 wide.
#include <algorithm>
#include <cmath>

#include "bricks.h"
#include "fractal.h"
#include "recipes.h"

namespace vkvol {
namespace {

constexpr double width = 96.0, depth = 64.0, height = 24.0;
constexpr double base = 15.0;       // of the cloud, where it is flat
constexpr double thickest = 5.0;    // from there to its top
constexpr double haze = 1.0 / 64.0; // density, everywhere but in the cloud

// How thick the cloud is here, in [0, 1]; 0 in its gaps.
double cover(double x, double z, std::uint32_t seed) {
    const glm::dvec3 p(x, 0.0, z);
    const glm::dvec3 q = p + 2.0 * noise_vector(p / 6.0, 2, seed + 1);
    const double cells = billow(q / 8.0 + 0.5, seed + 2), gaps = fbm(q / 7.0, 2, seed + 3);
    return smooth_step(-0.25, 0.2, gaps + 0.4 * (cells - 0.6));
}

double cloud(glm::dvec3 p, std::uint32_t seed) {
    const double here = cover(p.x, p.z, seed);
    if (here <= 0.0 || p.y < base - 2.0)
        return 0.0;
    const double rough = 0.9 * (billow(p / 2.6, seed + 4) - 0.6) + 0.5 * (billow(p / 1.2, seed + 5) - 0.6);
    const double top = base + thickest * here * (1.0 + 0.35 * rough), bottom = base - 0.6 * here + 0.5 * rough;
    return smooth_step(0.0, 0.9, std::min(top - p.y, p.y - bottom));
}

} // namespace

Field make_broken_cloud(int size, std::uint32_t seed) {
    Field field;
    field.voxel_size = width / size;
    const auto samples = [&](double length) { return int(std::floor(length / field.voxel_size)); };
    const IndexBox box{{-(size / 2), 0, -samples(depth / 2)},
                       {size - size / 2 - 1, samples(height) - 1, samples(depth / 2) - 1}};
    field.grids.push_back(grid_of(box, [&](glm::ivec3 index) {
        const double value = std::max(haze, cloud(glm::dvec3(index) * field.voxel_size, seed));
        return float(std::floor(value * 1024.0 + 0.5) / 1024.0);
    }));
    return field;
}

} // namespace vkvol
