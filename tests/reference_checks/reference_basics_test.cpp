// The scalar reference: random numbers, camera, chords and phase function.
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/reference/test_media.h"

using namespace reference;
using std::numbers::pi;

TEST_CASE("random numbers follow the specification", "[cpu][reference]") {
    // Worked out by a second implementation of the specification.
    CHECK(pcg4d({0, 0, 0, 0}) == std::array<std::uint32_t, 4>{0x0f02f829u, 0x2d568769u, 0x32b0c43bu, 0xd32548eau});
    CHECK(pcg4d({3 | 7 << 16, 11, 2, 42}) ==
          std::array<std::uint32_t, 4>{0x5592e3e5u, 0xb9ebb161u, 0xcddb84d0u, 0x9013f1f1u});

    const Draw draw{{0xffffffffu, 0x100u, 0x80000012u, 0u}};
    CHECK(draw.x() == 1.0 - 0x1p-24);
    CHECK(draw.y() == 0x1p-24);
    CHECK(draw.tap() == glm::dvec3(0.5, 0.0, 0x001200 * 0x1p-24));
    // Bytes f0 and bc, 3c and 1e, 78 and 35, by exclusive or.
    CHECK(Draw{{0x12355678u, 0x9abcdef0u, 0x0f1e2d3cu, 0u}}.tap().z == 0x4c224d * 0x1p-24);
    CHECK(draw.exponential(0) == Approx(32.0 * std::log(2.0)));
    CHECK(draw.exponential(2) == Approx(-std::log1p(-(0x80000012 * 0x1p-32))));
    CHECK(draw.exponential(3) == Approx(0xff * 0x1p-56));
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
