// The scalar reference: Perlin's noise, its bound, and integrals through it.
#include <catch2/catch.hpp>

#include "tests/reference/test_media.h"

using namespace reference;

TEST_CASE("Perlin noise is the published function", "[cpu][reference]") {
    CHECK(perlin({3.14, 42, 7}) == Approx(0.13691995878400012).epsilon(1e-12)); // Perlin's Java program
    Rng rng = stream(73);
    for (int i = 0; i < 1000; ++i) {
        const Draw a = rng.next();
        const glm::dvec3 lattice = glm::floor(glm::dvec3(a.x(), a.y(), a.z()) * 600.0 - 300.0);
        REQUIRE(perlin(lattice) == 0.0);
        REQUIRE(perlin(lattice + 0.3) == Approx(perlin(lattice + 256.0 + 0.3)).margin(1e-12)); // its period
    }
}

TEST_CASE("the bound of Perlin noise is tight", "[cpu][reference]") {
    // With the best gradient at each of the 8 corners, maximised by ever finer grids about the best point.
    const auto best = [](const glm::dvec3& f) {
        const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1.0, total = 0.0, least = 1.0;
            for (int axis = 0; axis < 3; ++axis) {
                const double d = corner >> axis & 1 ? 1.0 - f[axis] : f[axis];
                weight *= 1.0 - fade(d);
                total += d;
                least = std::min(least, d);
            }
            sum += weight * (total - least); // the two largest
        }
        return sum;
    };
    glm::dvec3 at(0.5);
    double most = 0.0;
    for (double half = 0.5; half > 1e-6; half *= 0.25) {
        const glm::dvec3 middle = at;
        for (int i = 0; i < 41 * 41 * 41; ++i) {
            const glm::dvec3 offset(i % 41 - 20, i / 41 % 41 - 20, i / 1681 - 20);
            const glm::dvec3 p = glm::clamp(middle + offset * half / 20.0, 0.0, 1.0);
            if (best(p) > most) {
                most = best(p);
                at = p;
            }
        }
    }
    CAPTURE(most);
    CHECK(most <= perlin_bound);
    CHECK(most > perlin_bound - 1e-4);
    Rng rng = stream(79);
    const vkvol::Noise noise{1.3, 4, 0.7, 2.0};
    for (int i = 0; i < 100000; ++i) {
        const Draw a = rng.next();
        const glm::dvec3 p = glm::dvec3(a.x(), a.y(), a.z()) * 256.0;
        REQUIRE(std::abs(perlin(p)) <= perlin_bound);
        REQUIRE(noise_density(noise, p) <= noise_bound(noise));
        REQUIRE(noise_density(noise, p) >= 0.0);
    }
    CHECK(noise_bound({1.0, 3, 0.5, 2.0}) == Approx(0.5 * (1.0 + 1.75 * perlin_bound)));
    CHECK(noise_bound({1.0, 1, 0.0, 2.0}) == Approx(0.5 * (1.0 + perlin_bound)));
}

TEST_CASE("the quadrature of noise equals a fine Riemann sum", "[cpu][reference]") {
    const Sample sample = make_sample(GENERATE(Kind::noise_sphere, Kind::chromatic_noise));
    const Interval inside = support(sample.medium, sample.ray).front();
    double sum = 0.0;
    constexpr int n = 400000; // midpoints: error of order (3.4 / n)^2 and, where fbm meets -1, (3.4 / n)
    for (int i = 0; i < n; ++i)
        sum += sample.medium.density(sample.ray.at(inside.t0 + inside.length() * (i + 0.5) / n)) * inside.length() / n;
    CHECK(density_integral(sample.medium, sample.ray) == Approx(sum).epsilon(1e-8));
}
