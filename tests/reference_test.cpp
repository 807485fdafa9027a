// The scalar reference against closed forms.
// Random results are judged by z = (mean - expected) / standard error with |z| < 4: significance 6.3e-5 per comparison,
// and by a Kolmogorov-Smirnov test at significance 1e-3. Seeds are fixed, so a run passes always or never.
#include <catch2/catch.hpp>
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unistd.h>

#include "tests/reference/reference.h"

using namespace reference;
using std::numbers::pi;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Mean {
    double mean = 0.0, m2 = 0.0;
    double n = 0.0;

    void add(double x) {
        n += 1.0;
        const double delta = x - mean;
        mean += delta / n;
        m2 += delta * (x - mean);
    }
    double standard_error() const { return std::sqrt(m2 / (n - 1.0) / n); }
    double z(double expected) const { return (mean - expected) / standard_error(); }
};

Rng stream(std::uint32_t seed) {
    return {0, 0, seed};
}

vkvol::Volume volume(double sigma_a, double sigma_s, double g = 0.0) {
    vkvol::Volume v;
    v.sigma_a = sigma_a;
    v.sigma_s = sigma_s;
    v.g = g;
    return v;
}

vkvol::Volume box(const glm::dvec3& size, double sigma_a, double sigma_s, double g = 0.0) {
    vkvol::Volume v = volume(sigma_a, sigma_s, g);
    v.shape = vkvol::Box{glm::dvec3(0.0), size};
    return v;
}

// Smooth-less field with empty and dense voxels next to each other, the hardest case for majorants.
Grid random_grid(const glm::dmat3& linear = glm::dmat3(1.0), const glm::dvec3& translation = glm::dvec3(0.0)) {
    const auto value = [](glm::ivec3 i) {
        const Draw draw{pcg4d({std::uint32_t(i.x), std::uint32_t(i.y), std::uint32_t(i.z), 1})};
        return draw.x() < 0.4 ? 0.0 : std::pow(draw.y(), 4.0) * 2.0;
    };
    return make_grid({-3, 2, 0}, {9, 12, 10}, value, linear, translation);
}

// Rotation, shear, unequal scales and a mirror.
const glm::dmat3 skewed(glm::dvec3(0.3, 0.4, 0.0), glm::dvec3(-0.5, 0.2, 0.1), glm::dvec3(0.05, 0.1, -0.6));

// One pixel that looks along -z from (0, 0, z): the field of view is so narrow that all rays are parallel.
vkvol::Scene pixel_scene(const vkvol::Volume& v, double z) {
    vkvol::Scene scene;
    scene.camera.position = {0.0, 0.0, z};
    scene.camera.fov = 1e-6;
    scene.picture = {1, 1, 0.0, 0.0, 1.0, 1.0};
    scene.volumes = {v};
    scene.settings.roulette_threshold = 0.1;
    scene.settings.filter = vkvol::Filter::trilinear;
    return scene;
}

Mean sample_pixel(const World& world, int count, std::uint32_t seed) {
    Mean mean;
    for (int i = 0; i < count; ++i)
        mean.add(trace_path(world, 0, 0, i, seed).x);
    return mean;
}

} // namespace

TEST_CASE("random numbers follow the specification", "[cpu][reference]") {
    // Worked out by a second implementation of the specification.
    CHECK(pcg4d({0, 0, 0, 0}) == std::array<std::uint32_t, 4>{0x0f02f829u, 0x2d568769u, 0x32b0c43bu, 0xd32548eau});
    CHECK(pcg4d({3 | 7 << 16, 11, 2, 42}) ==
          std::array<std::uint32_t, 4>{0x5592e3e5u, 0xb9ebb161u, 0xcddb84d0u, 0x9013f1f1u});

    const Draw draw{{0xffffffffu, 0x100u, 0x80000012u, 0u}};
    CHECK(draw.x() == 1.0 - 0x1p-24);
    CHECK(draw.y() == 0x1p-24);
    CHECK(draw.tap() == glm::dvec3(0.5, 0.0, 0xff0012 * 0x1p-24));
    CHECK(to_exponential(1.0 - 0x1p-24) == Approx(16.6355));
}

TEST_CASE("the camera looks along -z, up, left and counter-clockwise", "[cpu][reference]") {
    vkvol::Camera camera;
    const vkvol::Picture picture{200, 100, 0.0, 0.0, 200.0, 100.0};
    const auto looks = [&](double x, double y, glm::dvec3 expected) {
        return glm::distance(camera_ray(camera, picture, x, y).direction, glm::normalize(expected)) < 1e-12;
    };
    CHECK(looks(100, 50, {0, 0, -1}));
    CHECK(looks(200, 0, {2, 1, -1})); // fov 90: the upper edge at 45 degrees, twice as wide as high
    CHECK(looks(0, 100, {-2, -1, -1}));
    camera.pitch = 30.0;
    CHECK(looks(100, 50, {0, 0.5, -std::sqrt(0.75)}));
    camera.pitch = 0.0;
    camera.yaw = 90.0;
    CHECK(looks(100, 50, {-1, 0, 0}));
    camera.roll = 90.0; // about world z, after the yaw
    CHECK(looks(100, 50, {0, -1, 0}));

    // A window of a larger frame sees what the frame sees there.
    vkvol::Picture window = picture;
    window.start_x = 30.5;
    CHECK(glm::distance(camera_ray(camera, window, 10, 20).direction, camera_ray(camera, picture, 40.5, 20).direction) <
          1e-14);
}

TEST_CASE("chords of spheres and boxes", "[cpu][reference]") {
    const vkvol::Sphere sphere{{1, 2, 3}, 2.0};
    const vkvol::Box cube{{1, 2, 3}, {2, 4, 6}};
    Rng rng = stream(3);
    for (int i = 0; i < 1000; ++i) {
        const Draw a = rng.next();
        const Ray ray{glm::dvec3(a.x(), a.y(), a.z()) * 8.0 - 4.0, hg_sample(0.0, {0, 0, 1}, a.w(), a.tap().z)};
        CHECK(intersect(sphere, ray).length() == Approx(sphere_chord(sphere, ray)).margin(1e-7));
        const Interval inside = intersect(cube, ray);
        if (!inside.empty()) {
            const glm::dvec3 middle = glm::abs(ray.at(0.5 * (inside.t0 + inside.t1)) - cube.center);
            CHECK((middle.x <= 1.0 && middle.y <= 2.0 && middle.z <= 3.0));
        }
    }
    CHECK(box_chord(cube, {{1, 2, -9}, {0, 0, 1}}) == 6.0);
    CHECK(box_chord(cube, {{1, 4, -9}, {0, 0, 1}}) == 6.0); // in the upper face
    CHECK(box_chord(cube, {{1, 4.1, -9}, {0, 0, 1}}) == 0.0);
    CHECK(box_chord(cube, {{0, 1, 3}, glm::normalize(glm::dvec3(1, 1, 0))}) == Approx(std::sqrt(8.0)));
}

TEST_CASE("Henyey-Greenstein is normalised and has mean cosine g", "[cpu][reference]") {
    for (const double g : {-0.99, -0.5, -1e-5, 0.0, 1e-9, 1e-4, 0.3, 0.9, 0.999}) {
        CAPTURE(g);
        // Substituting the inverse distribution function would be circular: integrate over the angle from the peak,
        // theta = pi y^4, which resolves it.
        const double peak = g < 0.0 ? -1.0 : 1.0;
        double norm = 0.0, cosine = 0.0;
        constexpr int n = 200000;
        for (int i = 0; i < n; ++i) {
            const double y = (i + 0.5) / n, theta = pi * std::pow(y, 4), mu = peak * std::cos(theta);
            const double w = hg_eval(g, mu) * 2.0 * pi * std::sin(theta) * 4.0 * pi * std::pow(y, 3) / n;
            norm += w;
            cosine += w * mu;
        }
        CHECK(norm == Approx(1.0).epsilon(1e-6));
        CHECK(cosine == Approx(g).margin(1e-6));

        // The sampler inverts the distribution function of the density: d mu / du = 1 / (2 pi p).
        for (const double u : {0.01, 0.3, 0.5, 0.8, 0.99}) {
            const double h = 1e-6;
            const double slope = (hg_sample_cosine(g, u + h) - hg_sample_cosine(g, u - h)) / (2.0 * h);
            CHECK(slope * 2.0 * pi * hg_pdf(g, hg_sample_cosine(g, u)) == Approx(1.0).epsilon(1e-3));
        }
        const glm::dvec3 travel = glm::normalize(glm::dvec3(1, -2, 3));
        Rng rng = stream(5);
        Mean mean;
        for (int i = 0; i < 100000; ++i) {
            const Draw draw = rng.next();
            mean.add(glm::dot(hg_sample(g, travel, draw.y(), draw.z()), travel));
        }
        const double z = mean.z(g);
        CHECK(std::abs(z) < 4.0);
    }
    CHECK(hg_eval(0.0, 0.7) == Approx(0.25 / pi));
    CHECK(hg_eval(0.9, 1.0) == Approx(1.9 / (4.0 * pi * 0.01))); // forward for g > 0
}

TEST_CASE("a trilinear grid reaches one voxel beyond its active box", "[cpu][reference]") {
    // Row 18: a constant N^3 grid, ray along an axis: tau = sigma v N h.
    const Grid constant = make_grid(
        {0, 0, 0}, {4, 4, 4}, [](auto) { return 2.0; }, glm::dmat3(0.5));
    for (const auto unit : {vkvol::CoefficientUnit::voxel, vkvol::CoefficientUnit::world}) {
        vkvol::Volume v = volume(0.3, 0.4);
        v.unit = unit;
        const Medium medium = with_grid(constant, v);
        const double per_world = unit == vkvol::CoefficientUnit::world ? 0.7 : 0.7 / 0.5;
        CHECK(optical_depth(medium, {{1, 1, -50}, {0, 0, 1}}, 0, infinity) == Approx(per_world * 2.0 * 5 * 0.5));
        CHECK(optical_depth(medium, {{-50, 1, 1}, {1, 0, 0}}, 0, infinity) == Approx(per_world * 2.0 * 5 * 0.5));
        CHECK(optical_depth(medium, {{-50, 1, 2.25}, {1, 0, 0}}, 0, infinity) == Approx(per_world * 2.0 * 5 * 0.25));
    }
    // Row 14: a single voxel v has the area of a hat, v h; as a nearest-filtered box the same.
    const Grid spike = make_grid({7, 7, 7}, {7, 7, 7}, [](auto) { return 3.0; });
    for (const auto filter : {vkvol::Filter::trilinear, vkvol::Filter::nearest}) {
        const Medium medium = with_grid(spike, volume(0.5, 0.0), filter);
        CHECK(optical_depth(medium, {{7, 7, 0}, {0, 0, 1}}, 0, infinity) == Approx(0.5 * 3.0));
    }
    // Rows 13 and 17.
    CHECK(make_grid({0, 0, 0}, {-1, -1, -1}, [](auto) { return 1.0; }).empty());
    const Medium none = with_grid(Grid{}, volume(1, 1));
    CHECK(transmittance_quadrature(none, {{0, 0, 0}, {0, 0, 1}}, 0, infinity) == 1.0);
    for (const double bad : {-1.0, double(NAN), infinity, -infinity})
        CHECK(make_grid({0, 0, 0}, {0, 0, 0}, [=](auto) { return bad; }).voxel({0, 0, 0}) == 0.0);
}

TEST_CASE("majorants bound the interpolated density", "[cpu][reference]") {
    Grid grid = random_grid();
    const int cell = GENERATE(as<int>{}, one_cell, 1, 3, 8);
    build_majorants(grid, cell);
    Rng rng = stream(7);
    const glm::dvec3 lower(grid.lower), extent(grid.size - 1);
    for (int i = 0; i < 300; ++i) {
        const Draw a = rng.next();
        const Ray ray{lower + extent * glm::dvec3(a.x(), a.y(), a.z()), hg_sample(0.0, {0, 0, 1}, a.w(), a.tap().z)};
        const Interval inside = grid.support(ray);
        MajorantWalk walk(grid, ray, inside);
        MajorantSegment segment;
        double t = inside.t0;
        while (walk.next(segment)) {
            REQUIRE(segment.t0 == t);
            t = segment.t1;
            for (int k = 0; k < 5; ++k) {
                const glm::dvec3 p = ray.at(segment.t0 + (segment.t1 - segment.t0) * (k + 0.5) / 5.0);
                REQUIRE(grid.trilinear(p) <= segment.majorant + 1e-12);
                REQUIRE(grid.nearest(p) <= segment.majorant);
            }
        }
        REQUIRE(t == Approx(inside.t1).epsilon(1e-12));
    }
}

TEST_CASE("the quadrature equals a fine Riemann sum under any affine transform", "[cpu][reference]") {
    const glm::dvec3 translation(100.0, -20.0, 3.0);
    const auto filter = GENERATE(vkvol::Filter::trilinear, vkvol::Filter::nearest);
    const Medium medium = with_grid(random_grid(skewed, translation), volume(0.4, 0.8), filter);
    const glm::dvec3 middle = skewed * glm::dvec3(3, 7, 5) + translation;
    const double world_sigma_t = 1.2 / std::cbrt(std::abs(glm::determinant(skewed)));
    Rng rng = stream(9);
    for (int i = 0; i < 10; ++i) {
        const Draw a = rng.next();
        const glm::dvec3 d = hg_sample(0.0, {0, 0, 1}, a.x(), a.y());
        const Ray ray{middle - 20.0 * d + a.z(), d};
        double sum = 0.0;
        constexpr int n = 400000;
        for (int k = 0; k < n; ++k) // world distance: 40 units
            sum += medium.density(medium.grid()->to_index(ray.at(40.0 * (k + 0.5) / n))) * 40.0 / n;
        const double epsilon = filter == vkvol::Filter::nearest ? 1e-3 : 1e-7;
        CHECK(optical_depth(medium, ray, 0.0, infinity) == Approx(world_sigma_t * sum).epsilon(epsilon));
    }
}

TEST_CASE("free flights follow the exact distribution", "[cpu][reference]") {
    const auto filter = GENERATE(vkvol::Filter::trilinear, vkvol::Filter::nearest);
    const int cell = GENERATE(as<int>{}, one_cell, 2, 8);
    CAPTURE(cell);
    Grid grid = random_grid(skewed);
    build_majorants(grid, cell);
    const Medium medium = with_grid(std::move(grid), volume(0.2, 0.4), filter);
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, 1.0));
    const Ray ray{skewed * glm::dvec3(3, 7, 5) - 10.0 * d, d};

    constexpr int n = 20000;
    Rng rng = stream(11);
    std::vector<double> cdf; // the exact distribution function at the sampled distances
    Mean escaped;
    for (int i = 0; i < n; ++i) {
        const auto t = sample_collision(medium, ray, to_exponential(rng.next().x()), rng);
        escaped.add(t ? 0.0 : 1.0);
        if (t)
            cdf.push_back(1.0 - transmittance_quadrature(medium, ray, 0.0, *t));
    }
    const double T = transmittance_quadrature(medium, ray, 0.0, infinity);
    REQUIRE((T > 0.05 && T < 0.95));
    const double z = escaped.z(T);
    CHECK(std::abs(z) < 4.0);

    // Those that collide are distributed as F(t) / (1 - T). sqrt(m) D > 1.95 has probability 1e-3.
    std::sort(cdf.begin(), cdf.end());
    const double m = static_cast<double>(cdf.size());
    double D = 0.0;
    for (std::size_t i = 0; i < cdf.size(); ++i) {
        const double F = cdf[i] / (1.0 - T);
        D = std::max({D, F - i / m, (i + 1) / m - F});
    }
    const double kolmogorov = std::sqrt(m) * D;
    CHECK(kolmogorov < 1.95);
}

TEST_CASE("homogeneous free flights are exponential", "[cpu][reference]") {
    const Medium medium = load(box({2, 2, 1e9}, 0.5, 1.5));
    Rng rng = stream(13);
    Mean distance;
    for (int i = 0; i < 100000; ++i)
        distance.add(*sample_collision(medium, {{0, 0, 0}, {0, 0, 1}}, to_exponential(rng.next().x()), rng));
    const double z = distance.z(0.5); // the mean free path, 1 / sigma_t
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("ratio tracking has the mean of the quadrature", "[cpu][reference]") {
    const int cell = GENERATE(as<int>{}, one_cell, 2, 8);
    const double roulette = GENERATE(0.0, 0.1, 0.5);
    const double scale = GENERATE(0.3, 3.0);
    CAPTURE(cell, roulette, scale);
    Grid grid = random_grid(skewed);
    build_majorants(grid, cell);
    const Medium medium = with_grid(std::move(grid), volume(scale, 0.0));
    const glm::dvec3 d = glm::normalize(glm::dvec3(-1.0, 0.5, 0.4));
    const Ray ray{skewed * glm::dvec3(2, 8, 4) - 12.0 * d, d};
    Rng rng = stream(17);
    Mean T;
    for (int i = 0; i < 40000; ++i)
        T.add(ratio_transmittance(medium, ray, rng, roulette));
    const double z = T.z(transmittance_quadrature(medium, ray, 0.0, infinity));
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("the transmittance of slabs and spheres is exponential", "[cpu][reference]") {
    Rng rng = stream(0);
    for (const double tau : {1e-9, 1e-6, 1.0, 10.0, 80.0, 87.0, 88.0, 104.0, 1e4}) { // row 1
        const Medium slab = load(box({1e3, 1e3, 2.0}, 0.5 * tau, 0.0));
        CHECK(ratio_transmittance(slab, {{0, 0, 5}, {0, 0, -1}}, rng) == Approx(std::exp(-tau)).epsilon(1e-12));
        const glm::dvec3 oblique(0.6, 0.0, -0.8);
        CHECK(ratio_transmittance(slab, {{0, 0, 5}, oblique}, rng) == Approx(std::exp(-tau / 0.8)).epsilon(1e-10));
    }
    vkvol::Volume ball = volume(0.7, 0.0);
    ball.shape = vkvol::Sphere{{0, 0, 0}, 2.0};
    const Medium medium = load(ball);
    for (int i = 0; i < 100; ++i) { // row 20: from the centre
        const Draw a = rng.next();
        const Ray ray{{0, 0, 0}, hg_sample(0.0, {0, 0, 1}, a.x(), a.y())};
        CHECK(ratio_transmittance(medium, ray, rng) == Approx(std::exp(-1.4)).epsilon(1e-12));
    }
}

TEST_CASE("absorption and emission", "[cpu][reference]") {
    for (const double tau : {0.01, 1.0, 30.0}) { // row 2: Le (1 - exp(-tau)) + B exp(-tau)
        vkvol::Volume v = box({10, 10, 1}, tau, 0.0);
        v.Le = {5.0, 0.0, 0.0};
        vkvol::Scene scene = pixel_scene(v, 10.0);
        scene.background = {2.0, 0.0, 0.0};
        const double expected = 5.0 * -std::expm1(-tau) + 2.0 * std::exp(-tau);
        const Ray ray{{0, 0, 10}, {0, 0, -1}};
        CHECK(unscattered_quadrature(load(v), scene.background, ray).x == Approx(expected).epsilon(1e-12));
        const Mean L = sample_pixel(load_world(scene), 40000, 19);
        if (tau == 30.0) {
            CHECK(L.mean == 5.0); // a path gets through with probability 1e-13
        } else {
            const double z = L.z(expected);
            CHECK(std::abs(z) < 4.0);
        }
    }
}

TEST_CASE("the white furnace is exact per sample", "[cpu][reference]") {
    const double g = GENERATE(-0.5, 0.0, 0.85); // row 4
    vkvol::Volume v = volume(0.0, 1.5, g);
    World world{pixel_scene(v, 40.0), std::nullopt, false};
    world.scene.background = vkvol::Rgb(0.75);
    world.scene.camera.position = {3.0, 7.0, 40.0};
    world.medium = with_grid(random_grid(), v);
    vkvol::Volume ball = v;
    ball.shape = vkvol::Sphere{{3, 7, 5}, 3.0};
    for (int i = 0; i < 2000; ++i)
        REQUIRE(trace_path(world, 0, 0, i, 23) == vkvol::Rgb(0.75));
    world.medium = load(ball);
    for (int i = 0; i < 2000; ++i)
        REQUIRE(trace_path(world, 0, 0, i, 23) == vkvol::Rgb(0.75));

    // Row 5: with a limit the background is lost exactly where the limit was met.
    world.scene.settings.max_depth = 0;
    const Mean L = sample_pixel(world, 40000, 29);
    const double z = L.z(0.75 * std::exp(-1.5 * 6.0));
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("single scattering in a slab", "[cpu][reference]") {
    const double tau = GENERATE(1e-6, 0.3, 4.0); // rows 3 and 8
    const double g = GENERATE(0.0, 0.6);
    CAPTURE(tau, g);
    const vkvol::Volume v = box({1e5, 1e5, 1.0}, 0.3 * tau, 0.7 * tau, g);
    const glm::dvec3 away = glm::normalize(glm::dvec3(0.3, -0.4, 0.7));
    const bool below = GENERATE(false, true); // the light
    const double mu0 = away.z;
    const vkvol::DirectionalLight light{below ? -away : away, vkvol::Rgb(10.0)};
    const double p = hg_eval(g, glm::dot(light.direction, glm::dvec3(0, 0, -1)));
    const double expected = 10.0 * (below ? slab_single_transmission(0.7, p, tau, mu0, 1.0)
                                          : slab_single_reflection(0.7, p, tau, mu0, 1.0));
    const Ray ray{{0, 0, 10}, {0, 0, -1}};
    CHECK(single_scattering_quadrature(load(v), light, ray).x == Approx(expected).epsilon(1e-6));
    if (tau < 1e-3) {
        CHECK(expected == Approx(10.0 * 0.7 * p * tau).epsilon(1e-4));
        return;
    }
    vkvol::Scene scene = pixel_scene(v, 10.0);
    scene.lights = {light};
    scene.settings.max_depth = 1;
    const double z = sample_pixel(load_world(scene), 40000, 31).z(expected);
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("single scattering in a grid", "[cpu][reference]") {
    const vkvol::Volume v = volume(0.2, 0.6, 0.4);
    World world{pixel_scene(v, 20.0), with_grid(random_grid(skewed), v), true};
    const glm::dvec3 middle = skewed * glm::dvec3(3, 7, 5);
    world.scene.camera.position = {middle.x, middle.y, 20.0};
    world.scene.lights = {{glm::normalize(glm::dvec3(1, 2, -0.5)), vkvol::Rgb(3.0)},
                          {glm::normalize(glm::dvec3(-1, 0.3, 1)), vkvol::Rgb(4.0)}};
    world.scene.settings.max_depth = 1;
    const Ray ray{world.scene.camera.position, {0, 0, -1}};
    double expected = 0.0, coarse = 0.0;
    for (const auto& light : world.scene.lights) {
        expected += single_scattering_quadrature(*world.medium, light, ray, 16).x;
        coarse += single_scattering_quadrature(*world.medium, light, ray, 8).x;
    }
    CHECK(coarse == Approx(expected).epsilon(1e-5));
    const double z = sample_pixel(world, 100000, 37).z(expected);
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("a semi-infinite medium", "[cpu][reference]") {
    // Row 7, Chandrasekhar. The medium is a cube of 2000 mean free paths, seen along the normal of a face.
    struct Case {
        double albedo, plane_albedo, reflection;
    };
    const Case c =
        GENERATE(Case{0.5, 0.115226, 0.031148}, Case{0.9, 0.414947, 0.122572}, Case{0.99, 0.752721, 0.240863});
    CHECK(plane_albedo(c.albedo) == Approx(c.plane_albedo).epsilon(1e-4));
    CHECK(normal_reflection(c.albedo) == Approx(c.reflection).epsilon(1e-4));

    vkvol::Scene scene = pixel_scene(box(glm::dvec3(2000.0), 1.0 - c.albedo, c.albedo), 1001.0);
    scene.background = vkvol::Rgb(1.0); // by reciprocity the light of a white sky that comes back is the plane albedo
    const double z_albedo = sample_pixel(load_world(scene), 60000, 41).z(plane_albedo(c.albedo));
    CHECK(std::abs(z_albedo) < 4.0);

    scene.background = vkvol::Rgb(0.0);
    scene.lights = {{{0, 0, 1}, vkvol::Rgb(1.0)}};
    const double z_reflection = sample_pixel(load_world(scene), 60000, 43).z(normal_reflection(c.albedo));
    CHECK(std::abs(z_reflection) < 4.0);
}

TEST_CASE("a conservative slab under Lambertian light", "[cpu][reference]") {
    // Row 6. Nothing is lost, so that reflection is the rest; the published values are known to their own error.
    struct Case {
        double tau, transmission, error;
    };
    const Case c =
        GENERATE(Case{1, 0.552, 0.002}, Case{5, 0.212, 0.002}, Case{10, 0.118, 0.001}, Case{20, 0.062, 0.001});
    const Medium medium = load(box({1e6, 1e6, c.tau}, 0.0, 1.0));
    Rng rng = stream(47);
    Mean transmitted;
    for (int i = 0; i < 40000; ++i) {
        const Draw first = rng.next();
        const double mu = std::sqrt(1.0 - first.x());
        Ray ray{{0, 0, 0.5 * c.tau}, {std::sqrt(1.0 - mu * mu), 0.0, -mu}};
        double flight = to_exponential(first.y());
        while (const auto t = sample_collision(medium, ray, flight, rng)) {
            const Draw draw = rng.next();
            ray = {ray.at(*t), hg_sample(0.0, ray.direction, draw.y(), draw.z())};
            flight = to_exponential(draw.x());
        }
        transmitted.add(ray.direction.z < 0.0 ? 1.0 : 0.0);
    }
    CHECK(std::abs(transmitted.mean - c.transmission) < c.error + 4.0 * transmitted.standard_error());
    if (c.tau >= 10.0)
        CHECK(transmitted.mean ==
              Approx(diffuse_transmission_asymptote(c.tau)).margin(4.0 * transmitted.standard_error()));
}

TEST_CASE("a constant grid scatters like a homogeneous box", "[cpu][reference]") {
    // Row 32. Filtered by the nearest voxel, a constant grid of 8^3 voxels of edge 0.5 is a cube of edge 4.
    const auto preset = GENERATE("deltaTracking", "ratioTracking");
    const int cell = GENERATE(as<int>{}, one_cell, 3);
    vkvol::Volume v = box(glm::dvec3(4.0), 0.1, 0.9, 0.5);
    v.unit = vkvol::CoefficientUnit::world;
    v.Le = vkvol::Rgb(0.2);
    vkvol::Scene scene = pixel_scene(v, 10.0);
    scene.background = vkvol::Rgb(0.3);
    scene.lights = {{glm::normalize(glm::dvec3(1, 1, 1)), vkvol::Rgb(2.0)}};
    scene.settings.integrator = preset;
    World world = load_world(scene);
    const Mean homogeneous = sample_pixel(world, 60000, 53);
    Grid grid = make_grid(
        {0, 0, 0}, {7, 7, 7}, [](auto) { return 1.0; }, glm::dmat3(0.5), glm::dvec3(-1.75));
    build_majorants(grid, cell);
    world.medium = with_grid(std::move(grid), v, vkvol::Filter::nearest);
    const Mean heterogeneous = sample_pixel(world, 60000, 59);
    const double z = (homogeneous.mean - heterogeneous.mean) /
                     std::hypot(homogeneous.standard_error(), heterogeneous.standard_error());
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("a film does not depend on threads and merges by samples", "[cpu][reference]") {
    vkvol::Scene scene = pixel_scene(box(glm::dvec3(4.0), 0.1, 0.9), 10.0);
    scene.picture = {8, 6, 0.0, 0.0, 8.0, 6.0};
    scene.camera.fov = 40.0;
    scene.background = {1.0, 2.0, 3.0};
    const vkvol::Film all = render(scene, {0, 8, 0, 6}, 64, 61, 1);
    const vkvol::Film part = render(scene, {2, 7, 1, 5}, 64, 61, 3);
    const vkvol::Film a = render(scene, {0, 8, 0, 6}, 16, 61, 2);
    const vkvol::Film b = render(scene, {0, 8, 0, 6}, 48, 61, 2, 16);
    for (int y = 1; y < 5; ++y)
        for (int x = 2; x < 7; ++x)
            CHECK(part.mean[(y - 1) * 5 + (x - 2)] == all.mean[y * 8 + x]);
    for (std::size_t i = 0; i < all.pixel_count(); ++i) {
        CHECK(0.25f * a.mean[i].y + 0.75f * b.mean[i].y == Approx(all.mean[i].y));
        CHECK(all.samples[i] == 64);
    }
    scene.settings.integrator = "somethingElse";
    CHECK_THROWS(render(scene, {0, 8, 0, 6}, 1, 0, 1));
}

TEST_CASE("grids are read from .nvdb files", "[cpu][reference]") {
    const auto folder = std::filesystem::temp_directory_path() / ("reference_test_" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
    const auto path = folder / "random.nvdb";
    const Grid expected = random_grid();

    const auto round_trip = [&]<typename Build>(Build, double tolerance, nanovdb::io::Codec codec) {
        nanovdb::GridBuilder<float, Build> builder(0.0f);
        auto accessor = builder.getAccessor();
        for (int k = 0; k <= 10; ++k)
            for (int j = 2; j <= 12; ++j)
                for (int i = -3; i <= 9; ++i)
                    accessor.setValue(nanovdb::Coord(i, j, k), static_cast<float>(expected.voxel({i, j, k})));
        const auto handle = builder.getHandle(0.25, nanovdb::Vec3d(1, 2, 3), "density",
                                              nanovdb::AbsDiff(static_cast<float>(tolerance)));
        nanovdb::io::writeGrid(path.string(), handle, codec);

        vkvol::Volume v = volume(1, 1);
        v.shape = vkvol::GridFile{path, "density"};
        const Medium medium = load(v);
        const Grid& grid = *medium.grid();
        CHECK(grid.lower == expected.lower);
        CHECK(grid.size == expected.size);
        CHECK(grid.voxel_length() == Approx(0.25));
        CHECK(medium.sigma_t == Approx(8.0));
        CHECK(glm::distance(grid.translation, glm::dvec3(1, 2, 3)) < 1e-12);
        double worst = 0.0;
        for (std::size_t i = 0; i < grid.values.size(); ++i)
            worst = std::max(worst, std::abs(double(grid.values[i]) - expected.values[i]));
        CHECK(worst <= tolerance);
    };
    using nanovdb::io::Codec;
    round_trip(float{}, 0.0, Codec::ZIP); // the values lie in [0, 2]: a quantum is 2 / (2^bits - 1)
    round_trip(nanovdb::Fp16{}, 2.0 / 65535, Codec::BLOSC);
    round_trip(nanovdb::Fp8{}, 2.0 / 255, Codec::NONE);
    round_trip(nanovdb::Fp4{}, 2.0 / 15, Codec::NONE);
    round_trip(nanovdb::FpN{}, 0.01, Codec::NONE);

    CHECK_THROWS(load_grid(path, "temperature"));
    CHECK_THROWS(load_grid(folder / "missing.nvdb", "density"));
    CHECK_THROWS(load_grid(folder / "field.vdb", "density"));
    std::filesystem::remove_all(folder);
}
