// Media, scenes and streams that the tests of the reference share.
// Random results are judged by z = (mean - expected) / standard error with |z| < 4: significance 6.3e-5 per comparison,
// and by a Kolmogorov-Smirnov test at significance 1e-3. Seeds are fixed, so a run passes always or never.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference.h"
#include "shaders/shared/constants.h"
#include "tests/support/statistics.h"

namespace reference {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Mean : vkvol::RunningMean {
    double z(double expected) const { return (mean() - expected) / standard_error(); }
};

struct RgbMean {
    Mean channel[3];
    void add(const vkvol::Rgb& v) {
        for (int i = 0; i < 3; ++i)
            channel[i].add(v[i]);
    }
    // Largest |z| over the channels; `rounding` is forgiven, for what does not vary.
    double z(const vkvol::Rgb& expected, double rounding = 1e-12) const {
        double worst = 0.0;
        for (int i = 0; i < 3; ++i) {
            const double difference = std::abs(channel[i].mean() - expected[i]);
            if (!(difference <= rounding))
                vkvol::worsen(worst, difference / channel[i].standard_error());
        }
        return worst;
    }
};

// The largest |z| of the channels, between two estimates of the same.
inline double z_between(const RgbMean& a, const RgbMean& b) {
    double worst = 0.0;
    for (int i = 0; i < 3; ++i)
        vkvol::worsen(worst, std::abs(a.channel[i].mean() - b.channel[i].mean()) /
                                 std::hypot(a.channel[i].standard_error(), b.channel[i].standard_error()));
    return worst;
}

inline double z_between(const Mean& a, const Mean& b) {
    return (a.mean() - b.mean()) / std::hypot(a.standard_error(), b.standard_error());
}

inline Rng stream(std::uint32_t seed) {
    return {0, 0, seed};
}

inline vkvol::Volume volume(double sigma_a, double sigma_s, double g = 0.0) {
    vkvol::Volume v;
    v.sigma_a = vkvol::Rgb(sigma_a);
    v.sigma_s = vkvol::Rgb(sigma_s);
    v.g = g;
    return v;
}

inline vkvol::Volume box(const glm::dvec3& size, double sigma_a, double sigma_s, double g = 0.0) {
    vkvol::Volume v = volume(sigma_a, sigma_s, g);
    v.shape = vkvol::Box{glm::dvec3(0.0), size};
    return v;
}

// Field with empty and dense voxels next to each other, the hardest case for majorants.
inline Grid random_grid(const glm::dmat3& linear = glm::dmat3(1.0), const glm::dvec3& translation = glm::dvec3(0.0)) {
    const auto value = [](glm::ivec3 i) {
        const Draw draw{pcg4d({std::uint32_t(i.x), std::uint32_t(i.y), std::uint32_t(i.z), 1})};
        return draw.x() < 0.4 ? 0.0 : std::pow(draw.y(), 4.0) * 2.0;
    };
    return make_grid({-3, 2, 0}, {9, 12, 10}, value, linear, translation);
}

// Rotation, shear, unequal scales and a mirror.
inline const glm::dmat3 skewed(glm::dvec3(0.3, 0.4, 0.0), glm::dvec3(-0.5, 0.2, 0.1), glm::dvec3(0.05, 0.1, -0.6));

// One pixel that looks along -z from (0, 0, z): the field of view is so narrow that all rays are parallel.
inline vkvol::Scene pixel_scene(const vkvol::Volume& v, double z) {
    vkvol::Scene scene;
    scene.camera.position = {0.0, 0.0, z};
    scene.camera.fov = 1e-6;
    scene.picture = {1, 1, 0.0, 0.0, 1.0, 1.0};
    scene.volumes = {v};
    scene.settings.roulette_threshold = 0.1;
    scene.settings.filter = vkvol::Filter::trilinear;
    return scene;
}

inline Mean sample_pixel(const World& world, int count, std::uint32_t seed) {
    Mean mean;
    for (int i = 0; i < count; ++i)
        mean.add(trace_path(world, 0, 0, i, seed).x);
    return mean;
}

inline RgbMean sample_pixel_rgb(const World& world, int count, std::uint32_t seed) {
    RgbMean mean;
    for (int i = 0; i < count; ++i)
        mean.add(trace_path(world, 0, 0, i, seed));
    return mean;
}

// The radiance along a ray whose first flight and channel are drawn as by the camera.
inline RgbMean sample_ray(const World& world, const Ray& ray, int count, std::uint32_t seed) {
    RgbMean mean;
    for (int i = 0; i < count; ++i) {
        Rng rng{0, std::uint32_t(i), seed};
        const Draw first = rng.next();
        mean.add(radiance(world, ray, first.exponential(2), first.select(), rng));
    }
    return mean;
}

// Kinds of media that estimators must cope with, each with a ray through it of moderate optical depth.
enum class Kind { rough_grid, chromatic_grid, noise_sphere, chromatic_noise, noise_mesh, box, chromatic_box };

inline bool is_chromatic(Kind kind) {
    return kind == Kind::chromatic_grid || kind == Kind::chromatic_noise || kind == Kind::chromatic_box;
}

inline bool is_grid(Kind kind) {
    return kind == Kind::rough_grid || kind == Kind::chromatic_grid;
}

// Two bodies with a gap of 0.8 between them along z.
inline Mesh two_boxes() {
    Mesh mesh;
    for (const double low : {-1.8, 0.4}) {
        const auto corner = [&](int i) {
            return glm::dvec3(i & 1 ? 1.5 : -1.5, i & 2 ? 1.5 : -1.5, i & 4 ? low + 1.4 : low);
        };
        const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
        for (const auto& f : faces) {
            mesh.triangles.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
            mesh.triangles.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
        }
    }
    return mesh;
}

struct Sample {
    Medium medium;
    Ray ray;
    vkvol::March march;
};

inline Sample make_sample(Kind kind, double majorant_scale = 1.0) {
    vkvol::Volume v = volume(0.2, 0.4);
    if (is_chromatic(kind)) {
        v.sigma_a = {0.1, 0.3, 0.05};
        v.sigma_s = {0.4, 0.5, 0.2};
    }
    Sample sample;
    if (is_grid(kind)) {
        Grid grid = random_grid(skewed);
        build_majorants(grid, 3);
        sample.medium = with_grid(std::move(grid), v);
        const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, 1.0));
        sample.ray = {skewed * glm::dvec3(3, 7, 5) - 10.0 * d, d};
    } else {
        const bool constant = kind == Kind::box || kind == Kind::chromatic_box;
        if (!constant)
            v.noise = vkvol::Noise{1.3, 3, 0.6, 2.1};
        v.shape = vkvol::Sphere{{0.2, 0.1, 0.0}, 1.7};
        if (constant)
            v.shape = vkvol::Box{{0.2, 0.1, 0.0}, {2.0, 3.0, 2.5}};
        sample.medium = load(v);
        if (kind == Kind::noise_mesh)
            sample.medium.shape = two_boxes();
        sample.ray = {{0.4, -0.3, 5.0}, glm::normalize(glm::dvec3(0.02, 0.05, -1.0))};
    }
    sample.medium.majorant_scale = majorant_scale;
    sample.march = resolve_march({}, sample.medium);
    return sample;
}

} // namespace reference
