// A cumulus cloud: lobes on lobes on lobes, roughened by billows, cut flat at the condensation level, frayed at the
// base. Lengths are world units; the cloud is about 60 wide and stands on y = 0.
#include <algorithm>
#include <cmath>

#include "bricks.h"
#include "fractal.h"
#include "lobes.h"
#include "recipes.h"

namespace vkvol {
namespace {

constexpr double width = 64.0, height = 42.0; // of the index box: a margin around the cloud
constexpr double reach = 4.0;                 // how far from the lobes noise can move the surface

// The body: a broad foot of overlapping domes, and turrets that climb above a few of them.
std::vector<Lobe> body(std::uint32_t seed) {
    RandomStream random(seed);
    std::vector<Lobe> lobes;
    const auto add = [&](double x, double y, double z, double radius) {
        const glm::dvec3 shake = random.on_sphere() * (0.12 * radius);
        lobes.push_back({glm::dvec3(x, y, z) + shake, radius * random.between(0.92, 1.06)});
    };
    // The foot.
    add(-3, 6, 0, 9.5);
    add(8, 5.5, -2, 8.5);
    add(-13, 5, 1, 7.5);
    add(17, 5.5, 1, 7.0);
    add(-21.5, 3.8, -1.5, 5.6);
    add(23.5, 3.2, -1, 4.8);
    add(1, 4.5, 9, 7.0);
    add(-8, 4.5, 8, 6.0);
    add(9.5, 4, 7.5, 5.5);
    add(-4, 4.5, -9, 7.0);
    add(7, 4.5, -9.5, 6.5);
    // The main turret, leaning with the wind, and two lower ones.
    add(-4, 14, -0.5, 9.0);
    add(-3.5, 20.5, 0.5, 7.8);
    add(-1, 26, -0.5, 6.6);
    add(2, 29.5, 0, 5.0);
    add(10, 13, -2, 7.2);
    add(13, 18.5, -1.5, 5.6);
    add(15, 21.5, -1, 3.8);
    add(-14, 11, 0, 6.2);
    add(-16.5, 15, 0.5, 4.2);
    // Domes half way up, in front and behind.
    add(2.5, 12, 6.5, 5.2);
    add(-7.5, 13, 5.5, 4.6);
    add(3.5, 14, -7, 5.0);
    return lobes;
}

std::vector<Lobe> skeleton(std::uint32_t seed) {
    const std::vector<Lobe> first = body(seed);
    const std::vector<Lobe> second = bud(
        first, {.children = 20, .smallest = 0.28, .largest = 0.5, .upward = 0.4, .sunk = 0.2, .lowest = 0.5}, seed + 1);
    const std::vector<Lobe> third =
        bud(second, {.children = 16, .smallest = 0.28, .largest = 0.48, .upward = 0.3, .sunk = 0.25, .lowest = 0.3},
            seed + 2);
    std::vector<Lobe> all = first;
    all.insert(all.end(), second.begin(), second.end());
    all.insert(all.end(), third.begin(), third.end());
    return all;
}

class Cumulus {
public:
    explicit Cumulus(std::uint32_t seed) : seed_(seed), lobes_(skeleton(seed), 0.15, reach) {}

    std::vector<Lobe> near(glm::dvec3 center, double half_width) const { return lobes_.near(center, half_width); }

    double density(const std::vector<Lobe>& near, glm::dvec3 p) const {
        const double coarse = std::max(lobes_.distance(near, p), -p.y - 1.0);
        if (coarse > reach - 0.5)
            return 0.0;
        const double d = coarse < -reach ? coarse : surface(near, p);
        // Frayed towards the base, where the cloud evaporates; crisp on the lobes that still grow.
        const double age = 1.0 - smooth_step(1.0, 9.0, p.y);
        const double edge = 0.4 + 1.6 * age;
        const double body = smooth_step(0.0, edge, -d);
        const double depth = 0.75 + 0.25 * smooth_step(0.0, 3.0, -d);
        const double water = 0.7 + 0.3 * smooth_step(0.0, 20.0, p.y); // liquid water grows with height
        return body * depth * water;
    }

private:
    // Distance to the surface with its billows, wisps and base.
    double surface(const std::vector<Lobe>& near, glm::dvec3 p) const {
        // Warping space breaks the roundness of the lobes.
        const glm::dvec3 q = p + 0.9 * noise_vector(p / 5.5, 2, seed_ + 10);
        double d = lobes_.distance(near, q);
        // Billows grow upward and outward: their lattice is stretched a little along y.
        const glm::dvec3 b = q + 0.35 * noise_vector(p / 1.7, 2, seed_ + 20);
        const double vigour = 0.65 + 0.5 * gradient_noise(p / 9.0, seed_ + 30);
        d -= vigour * (1.30 * (billow(b / 3.1, seed_ + 41) - 0.62) + 0.72 * (billow(b / 1.45, seed_ + 42) - 0.62) +
                       0.44 * (billow(b / 0.72, seed_ + 43) - 0.62));
        const double age = 1.0 - smooth_step(0.5, 8.0, p.y);
        d += 0.12 * fbm(p / 0.9, 2, seed_ + 60);
        if (age > 0.0)
            d += age * 1.3 * fbm(p / 2.6, 4, seed_ + 50);
        if (p.y > 12.0) // far above the base
            return d;
        const double base = 1.2 + 0.9 * fbm({p.x / 7.0, 0.0, p.z / 7.0}, 3, seed_ + 70);
        return smooth_max(d, base - p.y, 1.6);
    }

    static double smooth_max(double a, double b, double k) {
        const double h = std::max(k - std::abs(a - b), 0.0) / k;
        return std::max(a, b) + h * h * k * 0.25;
    }

    std::uint32_t seed_;
    LobeUnion lobes_;
};

} // namespace

Field make_cumulus(int size, std::uint32_t seed) {
    Field field;
    field.voxel_size = width / size;
    const Cumulus cloud(seed);
    const int top = int(std::ceil(height / field.voxel_size));
    const IndexBox box{{-(size / 2), -2, -(size / 2)}, {size - size / 2 - 1, top, size - size / 2 - 1}};
    field.grids.resize(1);
    fill_bricks(box, field.grids, [&](std::span<Brick> channels) {
        Brick& brick = channels[0];
        const double half = 0.5 * brick_width * field.voxel_size;
        const auto near = cloud.near(glm::dvec3(brick.origin) * field.voxel_size + half, half);
        if (near.empty())
            return;
        for (int i = 0; i < brick_width; ++i)
            for (int j = 0; j < brick_width; ++j)
                for (int k = 0; k < brick_width; ++k) {
                    const glm::dvec3 p = glm::dvec3(brick.origin + glm::ivec3(i, j, k)) * field.voxel_size;
                    // Ten bits are more than a cloud shows, and pack into a third of the file.
                    const double density = cloud.density(near, p);
                    brick.value[Brick::offset(i, j, k)] = float(std::floor(density * 1024.0 + 0.5) / 1024.0);
                }
    });
    drop_islands(field.grids[0]);
    return field;
}

} // namespace vkvol
