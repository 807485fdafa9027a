// A head as a scanner sees it, for transfer functions: skin and flesh, skull, fluid, and a brain with furrows, grey
// outside and white within, each of a value of its own. Lengths are centimetres; the face looks along +z.
#include <algorithm>
#include <cmath>

#include "bricks.h"
#include "fractal.h"
#include "recipes.h"

namespace vkvol {
namespace {

// From without to within, so that from one to the next no third lies between.
constexpr double flesh = 0.25, bone = 0.5, fluid = 0.625, grey = 0.75, white = 0.875;
constexpr double soft = 0.12; // over which one tissue becomes another

// Distances to surfaces, below 0 within; roughly, of ellipsoids.
double ellipsoid(glm::dvec3 p, glm::dvec3 middle, glm::dvec3 radii) {
    const glm::dvec3 q = (p - middle) / radii;
    const double k0 = glm::length(q), k1 = glm::length(q / radii);
    return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -std::min({radii.x, radii.y, radii.z});
}

double capsule(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, double radius) {
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::length(p - a - t * (b - a)) - radius;
}

// Of two bodies that flow into each other over `width`.
double joined(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - 0.25 * h * h * width;
}

// As x is within the body, 1, or without, 0.
double within(double distance) {
    return smooth_step(-soft, soft, -distance);
}

double cranium(glm::dvec3 p) {
    return ellipsoid(p, {0.0, 3.0, -0.8}, {7.2, 8.2, 9.2});
}

double face(glm::dvec3 p) {
    const double cheeks = ellipsoid(p, {0.0, -3.6, 3.0}, {5.6, 7.2, 6.0});
    const double chin = ellipsoid(p, {0.0, -9.2, 5.0}, {3.4, 2.2, 3.6});
    return joined(cheeks, chin, 2.0);
}

double skin(glm::dvec3 p) {
    const glm::dvec3 side(std::abs(p.x), p.y, p.z);
    double d = joined(cranium(p), face(p), 2.5);
    d = joined(d, ellipsoid(p, {0.0, -3.4, 9.2}, {1.3, 2.2, 1.8}), 1.2); // nose
    d = joined(d, ellipsoid(p, {0.0, -6.9, 8.4}, {2.0, 0.8, 0.8}), 0.8); // lips
    d = joined(d, ellipsoid(side, {6.3, -1.8, -0.8}, {0.8, 2.4, 1.4}), 0.8);
    return joined(d, capsule(p, {0.0, -6.0, -2.0}, {0.0, -20.0, -3.5}, 5.0), 3.0);
}

// A shell about the brain, and one that is the face, with holes for eyes, nose and mouth.
double skull(glm::dvec3 p) {
    const glm::dvec3 side(std::abs(p.x), p.y, p.z);
    const double vault = std::abs(cranium(p) + 0.9) - 0.4;
    const double bones = std::max(std::abs(face(p) + 1.3) - 0.5, -(cranium(p) + 1.0));
    const double eyes = ellipsoid(side, {2.7, -1.3, 7.6}, {1.7, 1.5, 2.6});
    const double nose = ellipsoid(p, {0.0, -4.0, 8.0}, {1.1, 1.5, 2.0});
    const double bite = std::max(std::abs(p.y + 7.0) - 0.15, 3.0 - p.z);
    const double below = std::max(-p.z + 0.5, p.y + 4.0); // no bone behind the jaw
    const double spine = capsule(p, {0.0, -5.0, -3.5}, {0.0, -20.0, -4.0}, 1.4);
    const double front = std::max({bones, -eyes, -nose, -bite, below});
    return std::min({vault, front, spine});
}

// Depth below the brain's surface, which furrows cut into.
double brain_depth(glm::dvec3 p, std::uint32_t seed) {
    const glm::dvec3 bent = p + 0.7 * noise_vector(p / 2.5, 1, seed + 1);
    const double ridge = std::abs(gradient_noise(bent / 1.5, seed + 2));
    const double furrow = 1.5 * (1.0 - smooth_step(0.0, 0.22, ridge));
    const double cleft = p.y > 1.0 ? 3.5 * (1.0 - smooth_step(0.05, 0.3, std::abs(p.x))) : 0.0;
    const double big = ellipsoid(p, {0.0, 3.2, -0.8}, {5.6, 6.5, 7.6});
    const double small = ellipsoid(p, {0.0, -2.2, -4.8}, {3.6, 2.2, 2.8});
    const double stem = capsule(p, {0.0, -1.0, -2.6}, {0.0, -9.0, -3.6}, 0.9);
    const double cerebrum = -big - std::max(furrow, cleft);
    const double cerebellum = -small - 0.35 * (0.5 + 0.5 * std::cos(9.0 * p.y));
    return std::min(std::max({cerebrum, cerebellum, -stem}), std::max(-cranium(p) - 1.4, -stem));
}

double ventricles(glm::dvec3 p) {
    const glm::dvec3 side(std::abs(p.x), p.y, p.z);
    const double body = capsule(side, {0.7, 3.6, 2.8}, {1.4, 4.4, -3.2}, 0.5);
    return joined(body, capsule(side, {1.4, 4.4, -3.2}, {2.6, 1.4, -2.0}, 0.4), 0.4);
}

double tissue(glm::dvec3 p, std::uint32_t seed) {
    const double outside = skin(p);
    if (outside > soft)
        return 0.0;
    double value = flesh * within(outside);
    value = std::lerp(value, bone, within(skull(p)));
    value = std::lerp(value, fluid, within(cranium(p) + 1.3));
    const double depth = brain_depth(p, seed);
    value = std::lerp(value, grey, within(-depth));
    value = std::lerp(value, white, within(0.45 - depth));
    return std::lerp(value, fluid, within(ventricles(p)));
}

} // namespace

Field make_head(int size, std::uint32_t seed) {
    Field field;
    field.voxel_size = 26.0 / size;
    const auto index_of = [&](glm::dvec3 p) { return glm::ivec3(glm::floor(p / field.voxel_size)); };
    const IndexBox box{index_of({-8.4, -14.0, -10.4}), index_of({8.4, 11.8, 11.6})};
    field.grids.push_back(grid_of(box, [&](glm::ivec3 index) {
        const double value = tissue(glm::dvec3(index) * field.voxel_size, seed);
        return float(std::floor(value * 1024.0 + 0.5) / 1024.0);
    }));
    return field;
}

} // namespace vkvol
