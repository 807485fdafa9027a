// Free flights follow the exact distribution 1 - exp(-tau(t)), whatever the filter, the majorants and the transform.
// Judged by the probability integral transform: F(t) of those that collide is uniform (Kolmogorov-Smirnov), and as many
// escape as the exact transmittance says. Significance 1e-3 for each test case (Sidak), fixed seeds.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "flight.spv.h"
#include "kernels/test_items.h"
#include "support/numbers.h"
#include "support/statistics.h"
#include "support/test_grids.h"
#include "support/test_scene.h"
#include "tests/reference/quadrature.h"

using namespace vkvol;
using shared::FlightOutput;
using shared::RayInput;
using test_numbers::collided;
using test_numbers::infinity;
using test_numbers::left;

namespace {

constexpr float longest = 38.81624f; // exponential variate, -log(2^-56)

Volume medium_of(double sigma_t) {
    Volume volume;
    volume.sigma_a = Rgb(0.4 * sigma_t);
    volume.sigma_s = Rgb(0.6 * sigma_t);
    volume.unit = CoefficientUnit::world;
    return volume;
}

std::vector<FlightOutput> fly(const TestScene& scene, const std::vector<RayInput>& rays) {
    KernelRunner runner(flight_spv, scene.specialization, scene.kernel);
    runner.push.step_limit = 20000;
    return runner.run<FlightOutput>(rays);
}

std::vector<RayInput> repeat(const TestScene& scene, const reference::Ray& ray, int count, std::uint32_t seed) {
    std::mt19937 engine(seed);
    std::vector<RayInput> rays;
    for (int i = 0; i < count; ++i)
        rays.push_back({scene.to_render(ray.origin), ray.direction, std::uint32_t(engine()),
                        static_cast<float>(-std::log1p(-(engine() * 0x1p-32))), 0.0f, glm::vec3(1.0f)});
    return rays;
}

// Flights along `ray` against the optical depth tau(t) from its origin and that of the whole ray.
template <class Tau>
void check_flights(const std::vector<FlightOutput>& flights, const Tau& tau, double tau_end, double significance) {
    const double T = std::exp(-tau_end);
    std::vector<double> uniforms;
    int escaped = 0;
    for (const FlightOutput& f : flights) {
        REQUIRE((f.event == collided || f.event == left));
        if (f.event == left)
            ++escaped;
        else
            uniforms.push_back(-std::expm1(-tau(f.t)) / (1.0 - T));
    }
    const double n = flights.size(), z = (escaped - n * T) / std::sqrt(n * T * (1.0 - T));
    CAPTURE(T, escaped / n);
    CHECK(normal_p(z) > significance);
    CHECK(kolmogorov_smirnov_p(uniforms) > significance);
}

// Three rays through the middle of the grid, from without and from within.
std::vector<reference::Ray> rays_through(const TestGrid& grid) {
    const glm::dmat4& m = grid.field().index_to_world;
    const auto world = [&](glm::dvec3 index) { return glm::dvec3(m * glm::dvec4(index, 1.0)); };
    const glm::dvec3 low = world(glm::dvec3(grid.voxel_min) - 4.0), high = world(glm::dvec3(grid.voxel_max) + 2.0);
    const glm::dvec3 middle = world(0.5 * glm::dvec3(grid.voxel_min + grid.voxel_max) + 0.3);
    return {{low, glm::normalize(high - low)},
            {middle, glm::normalize(glm::dvec3(0.3, -0.5, 1.0))},
            {middle - 10.0 * glm::normalize(glm::dvec3(1.0, 0.2, -0.1)), glm::normalize(glm::dvec3(1.0, 0.2, -0.1))}};
}

} // namespace

TEST_CASE("delta tracking through a rough grid follows the optical depth", "[gpu][free_flight]") {
    struct Case {
        Filter filter;
        int cell;
        float majorant_scale;
    };
    const Case c =
        GENERATE(Case{Filter::trilinear, 8, 1.0f}, Case{Filter::trilinear, 8, 2.0f}, Case{Filter::trilinear, 8, 8.0f},
                 Case{Filter::stochastic, 8, 1.0f}, Case{Filter::stochastic, 8, 2.0f},
                 Case{Filter::stochastic, 8, 8.0f}, Case{Filter::nearest, 8, 1.0f}, Case{Filter::stochastic, 4, 1.0f},
                 Case{Filter::trilinear, 5, 1.0f}, Case{Filter::stochastic, 16, 1.0f});
    const bool moved = GENERATE(false, true);
    CAPTURE(int(c.filter), c.cell, c.majorant_scale, moved);
    GridRecipe recipe = rough_recipe();
    recipe.cell = c.cell;
    if (moved) { // turned, sheared, mirrored, and far from the world's origin (rows 22 and 24)
        recipe.linear = skewed;
        recipe.translation = {3.0e5, -1.0e5, 2.0e4};
    }
    TestGrid grid = make_test_grid(recipe);
    grid.change_majorants([&](MajorantGrid& majorants) {
        for (float& bound : majorants.bounds)
            bound *= c.majorant_scale;
    });
    const Volume volume = medium_of(moved ? 1.0 : 0.4);
    const TestScene scene = make_test_scene(grid.volume, volume, c.filter);
    const reference::Medium medium = reference::with_grid(
        make_reference_grid(grid), volume, c.filter == Filter::nearest ? Filter::nearest : Filter::trilinear);
    for (const reference::Ray& ray : rays_through(grid)) {
        const auto flights = fly(scene, repeat(scene, ray, 10000, 1));
        const double tau_end = reference::optical_depth(medium, ray, 0.0, infinity);
        REQUIRE(tau_end > 0.1);
        REQUIRE(tau_end < 6.0);
        check_flights(
            flights, [&](double t) { return reference::optical_depth(medium, ray, 0.0, t); }, tau_end,
            sidak(1e-3, 20 * 3 * 2));
    }
}

TEST_CASE("flights in spheres and boxes are exponential", "[gpu][free_flight]") {
    const bool ball = GENERATE(true, false);
    const double tau = GENERATE(0.01, 1.0, 5.0);
    CAPTURE(ball, tau);
    Volume volume = medium_of(tau / 2.0);
    const glm::dvec3 center(100.0, -7.0, 3.0);
    if (ball)
        volume.shape = Sphere{center, 2.0};
    else
        volume.shape = Box{center, {3.0, 4.0, 5.0}};
    const TestScene scene = make_test_scene(volume);
    const reference::Medium medium = reference::load(volume);
    for (const double from : {0.5, 9.0}) { // from within and from without
        const glm::dvec3 d = glm::normalize(glm::dvec3(-0.4, 0.3, 0.8));
        const reference::Ray ray{center + glm::dvec3(0.1, 0.2, 0.0) - from * d, d};
        const reference::Interval inside = reference::support(medium, ray).front();
        REQUIRE(inside.length() > 1.0);
        const auto flights = fly(scene, repeat(scene, ray, 50000, 2));
        check_flights(
            flights, [&](double t) { return tau / 2.0 * (t - inside.t0); }, tau / 2.0 * inside.length(),
            sidak(1e-3, 2 * 3 * 2 * 2));
    }
}

TEST_CASE("no random number leads to anything but a distance", "[gpu][free_flight][hard]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::stochastic);
    GridRecipe constant = rough_recipe();
    constant.value = [](glm::ivec3) { return 0.7f; };
    for (const GridRecipe& recipe : {rough_recipe(), constant})
        for (const double sigma_t : {1e-6, 1.0, 1e3}) {
            CAPTURE(sigma_t);
            const TestGrid grid = make_test_grid(recipe);
            const TestScene scene = make_test_scene(grid.volume, medium_of(sigma_t), filter);
            std::vector<RayInput> rays;
            for (const reference::Ray& ray : rays_through(grid))
                for (RayInput r : repeat(scene, ray, 200, 3))
                    for (const float e : {0.0f, 0x1p-54f, 0.5f, longest}) {
                        r.e = e;
                        rays.push_back(r);
                    }
            for (const FlightOutput& f : fly(scene, rays)) {
                REQUIRE((f.event == collided || f.event == left));
                REQUIRE(std::isfinite(f.t));
                REQUIRE(f.t >= 0.0f);
                REQUIRE(f.t < 100.0f);
            }
        }
    // The least exponential collides where the medium begins; the largest goes -log(2^-56) mean free paths.
    Volume ball = medium_of(1.0);
    ball.shape = Sphere{glm::dvec3(0.0), 20.0};
    const TestScene scene = make_test_scene(ball);
    const auto ends = fly(scene, {{{-30, 0, 0}, {1, 0, 0}, 1, 0.0f, 0.0f, glm::vec3(1.0f)},
                                  {{-30, 0, 0}, {1, 0, 0}, 1, longest, 0.0f, glm::vec3(1.0f)}});
    CHECK(ends[0].event == collided);
    CHECK(ends[0].t == Approx(10.0));
    CHECK(ends[1].event == collided);
    CHECK(ends[1].t == Approx(10.0 + 56.0 * std::log(2.0)));
}

TEST_CASE("where the majorant is the density no collision is null", "[gpu][free_flight][hard]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::stochastic, Filter::nearest);
    const float density = GENERATE(1.0f, 0.3f);
    GridRecipe recipe;
    recipe.last = {39, 39, 39};
    recipe.value = [=](glm::ivec3) { return density; };
    const TestGrid grid = make_test_grid(recipe);
    const TestScene scene = make_test_scene(grid.volume, medium_of(2.0 / density), filter);
    const glm::dvec3 middle(19.5);
    std::vector<RayInput> rays;
    std::mt19937 engine(4);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(normal(engine), normal(engine), normal(engine)));
        for (const RayInput& r : repeat(scene, {middle, d}, 100, engine()))
            rays.push_back(r);
    }
    int within = 0;
    for (const FlightOutput& f : fly(scene, rays))
        if (f.event == collided && f.t < 20.0f) { // never left the interior, where every voxel is the same
            ++within;
            REQUIRE(f.nulls == 0u);
        }
    CHECK(within == static_cast<int>(rays.size())); // 40 mean free paths
}
