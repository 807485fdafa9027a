// A fireball a second after ignition: a mushroom head that rolls upward on a stem of fire, with sooty lobes outside and
// a burning core that shows through the cracks between them. Lengths are world units; the box is 16 wide.
#include <algorithm>
#include <cmath>

#include "bricks.h"
#include "fractal.h"
#include "lobes.h"
#include "recipes.h"

namespace vkvol {
namespace {

constexpr double width = 16.0, height = 17.0;
constexpr double reach = 1.6; // how far from the lobes noise can move the surface

std::vector<Lobe> body(std::uint32_t seed) {
    RandomStream random(seed);
    std::vector<Lobe> lobes{{{0.0, 10.2, 0.0}, 3.3}, {{0.2, 12.0, -0.2}, 2.5}, {{0.1, 7.2, 0.0}, 1.7},
                            {{-0.1, 5.2, 0.1}, 1.4}, {{0.1, 3.3, 0.0}, 1.5},   {{0.0, 1.6, 0.0}, 1.9}};
    // The rolled-up rim of the head and the skirt of dust at the ground: rings of lobes.
    const auto ring = [&](double y, double distance, double radius, int count) {
        for (int n = 0; n < count; ++n) {
            glm::dvec3 d = random.on_sphere();
            d = glm::normalize(glm::dvec3(d.x, 0.0, d.z) + 1e-3);
            lobes.push_back(
                {glm::dvec3(0.0, y + random.between(-0.5, 0.5), 0.0) + d * distance * random.between(0.85, 1.1),
                 radius * random.between(0.8, 1.15)});
        }
    };
    ring(9.3, 3.2, 1.7, 14);
    ring(0.8, 3.0, 1.0, 13);
    return lobes;
}

std::vector<Lobe> skeleton(std::uint32_t seed) {
    std::vector<Lobe> all = body(seed);
    const Budding rule{.children = 14, .smallest = 0.3, .largest = 0.5, .upward = 0.3, .sunk = 0.3, .lowest = 0.3};
    const std::vector<Lobe> second = bud(all, rule, seed + 1);
    all.insert(all.end(), second.begin(), second.end());
    return all;
}

struct Sample {
    double density = 0.0;     // soot and dust, [0, 1]
    double temperature = 0.0; // [0, 3]; 1.5 and above burns
};

class Fireball {
public:
    explicit Fireball(std::uint32_t seed) : seed_(seed), lobes_(skeleton(seed), 0.2, reach) {}

    std::vector<Lobe> near(glm::dvec3 center, double half_width) const { return lobes_.near(center, half_width); }

    Sample at(const std::vector<Lobe>& near, glm::dvec3 p) const {
        if (lobes_.distance(near, p) > reach - 0.2)
            return {};
        const glm::dvec3 q = p + 0.45 * noise_vector(p / 2.2, 2, seed_ + 10);
        const double large = billow(q / 1.5, seed_ + 41), small = billow(q / 0.72, seed_ + 42);
        const double fine = billow(q / 0.36, seed_ + 43);
        const double bump = 0.62 * (large - 0.62) + 0.34 * (small - 0.62) + 0.16 * (fine - 0.62);
        double d = lobes_.distance(near, q) - bump + 0.1 * fbm(p / 0.8, 3, seed_ + 50);
        d = std::max(d, 0.12 - p.y);
        if (d >= 0.0)
            return {};
        // A crack is a crease of the billows: there the surface lies deep and the heat comes through.
        const double crack = 1.0 - smooth_step(-0.30, 0.28, bump);
        const double soot = smooth_step(0.0, 0.35, -d) * (0.6 + 0.4 * smooth_step(0.0, 1.2, -d));
        return {soot * (1.0 - 0.75 * crack), temperature(p, -d, crack)};
    }

private:
    // Hot inside, cooled by the air at the skin, and less so in cracks; the head burns longer than the foot.
    double temperature(glm::dvec3 p, double depth, double crack) const {
        const double inside = smooth_step(0.05, 1.2, depth + 0.95 * crack);
        const double burning = 0.55 + 0.45 * smooth_step(0.5, 7.5, p.y) - 0.25 * smooth_step(11.0, 15.0, p.y);
        const double flicker = 1.0 + 0.35 * fbm(p / 1.9, 3, seed_ + 60);
        const double skin = smooth_step(0.0, 0.12, depth);
        return skin * std::clamp(0.25 + 2.9 * inside * burning * flicker, 0.0, 3.0);
    }

    std::uint32_t seed_;
    LobeUnion lobes_;
};

float rounded(double value, double steps) {
    return float(std::floor(value * steps + 0.5) / steps);
}

} // namespace

Field make_explosion(int size, std::uint32_t seed) {
    Field field;
    field.voxel_size = width / size;
    field.grids.resize(2);
    field.grids[1].name = "temperature";
    const Fireball fireball(seed);
    const int top = int(std::ceil(height / field.voxel_size));
    const IndexBox box{{-(size / 2), 0, -(size / 2)}, {size - size / 2 - 1, top, size - size / 2 - 1}};
    fill_bricks(box, field.grids, [&](std::span<Brick> channels) {
        const glm::ivec3 origin = channels[0].origin;
        const double half = 0.5 * brick_width * field.voxel_size;
        const auto near = fireball.near(glm::dvec3(origin) * field.voxel_size + half, half);
        if (near.empty())
            return;
        for (int i = 0; i < brick_width; ++i)
            for (int j = 0; j < brick_width; ++j)
                for (int k = 0; k < brick_width; ++k) {
                    const Sample sample =
                        fireball.at(near, glm::dvec3(origin + glm::ivec3(i, j, k)) * field.voxel_size);
                    // Ten bits each are more than a flame shows, and pack into a third of the file.
                    channels[0].value[Brick::offset(i, j, k)] = rounded(sample.density, 1024.0);
                    channels[1].value[Brick::offset(i, j, k)] = rounded(sample.temperature, 256.0);
                }
    });
    drop_islands(field.grids[0]);
    drop_islands(field.grids[1]);
    return field;
}

} // namespace vkvol
