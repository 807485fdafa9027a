// Transmittance estimates have the exact mean, from quadrature or a closed form. Significance 1e-3 for each test case
// (Sidak), fixed seeds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "kernels/test_items.h"
#include "support/numbers.h"
#include "support/statistics.h"
#include "support/test_grids.h"
#include "support/test_scene.h"
#include "tests/reference/quadrature.h"
#include "transmittance.spv.h"

using namespace vkvol;
using shared::FlightOutput;
using shared::RayInput;
using test_numbers::infinity;
using test_numbers::left;

namespace {

Volume absorber(double sigma_t) {
    Volume volume;
    volume.sigma_a = Rgb(sigma_t);
    volume.sigma_s = Rgb(0.0);
    volume.unit = CoefficientUnit::world;
    return volume;
}

// `count` estimates along each ray.
std::vector<RunningMean> estimate(const TestScene& scene, const std::vector<reference::Ray>& rays, std::uint32_t count,
                                  std::uint32_t seed) {
    std::vector<RayInput> inputs;
    for (std::size_t i = 0; i < rays.size(); ++i)
        inputs.push_back(
            {scene.to_render(rays[i].origin), rays[i].direction, seed + std::uint32_t(i), 0.0f, 0.0f, glm::vec3(1.0f)});
    KernelRunner runner(transmittance_spv, scene.specialization, scene.kernel);
    runner.push.step_limit = 20000;
    runner.push.sample_end = count;
    const auto threads = static_cast<std::uint32_t>(rays.size() * count);
    const auto outputs = runner.run<FlightOutput>(std::span<const RayInput>(inputs), threads, threads);
    std::vector<RunningMean> means(rays.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        REQUIRE(outputs[i].event == left);
        means[i / count].add(outputs[i].weight.x);
    }
    return means;
}

double mean_p(const TestScene& scene, const reference::Ray& ray, std::uint32_t count, double expected) {
    // Estimates are products of a few dozen factors in single precision.
    return t_test_p(estimate(scene, {ray}, count, 1).front(), expected, 1e-5 * expected);
}

void scale_majorants(TestGrid& grid, float scale) {
    grid.change_majorants([&](MajorantGrid& majorants) {
        for (float& bound : majorants.bounds)
            bound *= scale;
    });
}

} // namespace

TEST_CASE("ratio tracking has the mean of the quadrature on 1000 random rays", "[gpu][transmittance][long]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::stochastic);
    const float scale = GENERATE(1.0f, 4.0f);
    GridRecipe recipe = rough_recipe();
    recipe.linear = skewed;
    recipe.translation = {100.0, -20.0, 3.0};
    TestGrid grid = make_test_grid(recipe);
    scale_majorants(grid, scale);
    const Volume volume = absorber(1.0);
    const TestScene scene = make_test_scene(grid.volume, volume, filter);
    const reference::Medium medium = reference::with_grid(make_reference_grid(grid), volume);
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform;
    const auto point = [&](double border) {
        const glm::dvec3 u(uniform(engine), uniform(engine), uniform(engine));
        const glm::dvec3 low = glm::dvec3(grid.voxel_min) - border, high = glm::dvec3(grid.voxel_max) + border;
        return glm::dvec3(grid.field().index_to_world * glm::dvec4(low + u * (high - low), 1.0));
    };
    std::vector<reference::Ray> rays;
    std::vector<double> expected;
    while (rays.size() < 1000) {
        const glm::dvec3 from = point(4.0), to = point(-2.0);
        const reference::Ray ray{from, glm::normalize(to - from)};
        const double T = reference::transmittance_quadrature(medium, ray, 0.0, infinity);
        // Below, roulette leaves too few estimates other than 0 for a t-test; below 1 by rounding, too little variance.
        if (T > 0.1 && T < 0.99) {
            rays.push_back(ray);
            expected.push_back(T);
        }
    }
    const auto means = estimate(scene, rays, scale > 1.0f ? 250 : 1000, 10);
    double difference = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        CAPTURE(i, means[i].mean(), expected[i], means[i].standard_error());
        CHECK(t_test_p(means[i], expected[i], 1e-6) > sidak(1e-3, 4 * 1001));
        difference += means[i].mean() - expected[i];
        variance += means[i].standard_error() * means[i].standard_error();
    }
    // All together: a bias too small for any one ray.
    CAPTURE(difference / rays.size(), std::sqrt(variance) / rays.size());
    CHECK(normal_p(difference / std::sqrt(variance)) > sidak(1e-3, 4 * 1001));
}

TEST_CASE("homogeneous transmittance is exp(-tau), to the end of the floats", "[gpu][transmittance][hard]") {
    for (const double tau : {1e-9, 1e-6, 1.0, 10.0, 80.0, 87.0, 88.0, 104.0, 1e4}) {
        CAPTURE(tau);
        Volume box = absorber(tau / 2.0);
        box.shape = Box{glm::dvec3(5.0), {100.0, 100.0, 2.0}};
        Volume ball = absorber(tau / 4.0);
        ball.shape = Sphere{glm::dvec3(-3.0, 0.0, 1.0), 2.0};
        const RunningMean slab = estimate(make_test_scene(box), {{{5, 5, 9}, {0, 0, -1}}}, 1, 1).front();
        const RunningMean chord = estimate(make_test_scene(ball), {{{-3, 0, -9}, {0, 0, 1}}}, 1, 1).front();
        const double expected = std::exp(-tau);
        for (const double T : {slab.mean(), chord.mean()}) {
            REQUIRE(T >= 0.0);
            if (expected < 1.5e-38) // below the least normal float anything up to it will do
                CHECK(T <= 1.5e-38);
            else // sigma and the chord are off by a few ulp, seen tau times; exp by 3 + 2 tau ulp (Vulkan's bound)
                CHECK(T == Approx(expected).epsilon((3.0 + 8.0 * tau) * 0x1p-23));
        }
    }
    Volume ball = absorber(0.7);
    ball.shape = Sphere{glm::dvec3(1e5, 0.0, 0.0), 2.0};
    std::mt19937 engine(2);
    std::normal_distribution<double> normal;
    std::vector<reference::Ray> rays;
    for (int i = 0; i < 100; ++i) // row 20: from the centre in every direction
        rays.push_back({{1e5, 0.0, 0.0}, glm::normalize(glm::dvec3(normal(engine), normal(engine), normal(engine)))});
    for (const RunningMean& T : estimate(make_test_scene(ball), rays, 1, 1))
        CHECK(T.mean() == Approx(std::exp(-1.4)).epsilon(16 * 0x1p-23));
}

TEST_CASE("a constant grid of N voxels is N voxels thick", "[gpu][transmittance][hard][long]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::stochastic, Filter::nearest);
    const float scale = GENERATE(1.0f, 3.0f);
    const int N = GENERATE(1, 5, 16);
    const double tau = GENERATE(0.5, 3.0, 10.0, 88.0, 1e4);
    CAPTURE(int(filter), scale, N, tau);
    const double h = 0.25, density = 0.6;
    GridRecipe recipe;
    recipe.first = glm::ivec3(-7);
    recipe.last = recipe.first + (N - 1);
    recipe.value = [=](glm::ivec3) { return static_cast<float>(density); };
    recipe.linear = glm::dmat3(h);
    TestGrid grid = make_test_grid(recipe);
    scale_majorants(grid, scale);
    const double sigma = tau / (float(density) * N * h);
    const TestScene scene = make_test_scene(grid.volume, absorber(sigma), filter);
    const glm::dvec3 middle = scene.render_origin;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 d(0.0);
        d[axis] = axis == 1 ? -1.0 : 1.0;
        // A ray through voxel centres: a whole number of voxels from the middle where N is odd.
        const reference::Ray ray{middle + (N % 2 == 0 ? 0.5 * h : 0.0) * (glm::dvec3(1.0) - glm::abs(d)) - 20.0 * d, d};
        const RunningMean T = estimate(scene, {ray}, tau > 20.0 ? 200 : 10000, 5).front();
        if (tau > 20.0) // an estimate other than 0, at least 0.1 by roulette, has a probability below 1e-8
            CHECK(T.mean() == 0.0);
        else if (tau > 5.0) { // the few estimates that survive roulette are binomial rather than normal
            CHECK(T.mean() < 10.0 * std::exp(-tau));
        } else
            CHECK(t_test_p(T, std::exp(-tau), 1e-5) > sidak(1e-3, 3 * 3 * 2 * 3 * 2));
    }
}

TEST_CASE("a spike casts the shadow of a hat, whatever the majorants", "[gpu][transmittance][hard]") {
    const int cell = GENERATE(1, 4, 8, 16);
    const float scale = GENERATE(1.0f, 4.0f, 100.0f);
    const Filter filter = GENERATE(Filter::trilinear, Filter::stochastic);
    CAPTURE(cell, scale, int(filter));
    const double h = 2.0, v = 3.0, sigma = 0.2;
    GridRecipe recipe; // two voxels far apart, so that majorant cells differ
    recipe.first = {0, 0, 0};
    recipe.last = {40, 0, 0};
    recipe.value = [=](glm::ivec3 i) { return i.x == 7 ? float(v) : i.x == 40 ? 1.0f : 0.0f; };
    recipe.linear = glm::dmat3(h);
    recipe.cell = cell;
    TestGrid grid = make_test_grid(recipe);
    scale_majorants(grid, scale);
    const TestScene scene = make_test_scene(grid.volume, absorber(sigma), filter);
    const double significance = sidak(1e-3, 2 * 4 * 3 * 2);
    const std::uint32_t count = scale > 10.0f ? 4000 : 20000; // which costs as many lookups
    CHECK(mean_p(scene, {{7 * h, 0, -30}, {0, 0, 1}}, count, std::exp(-sigma * v * h)) > significance);
    CHECK(mean_p(scene, {{-30, 0, 0}, {1, 0, 0}}, count, std::exp(-sigma * (v + 1.0) * h)) > significance);
}

TEST_CASE("majorants that are too low are counted, and the mean stays", "[gpu][transmittance][hard]") {
    // Row 15: ratio tracking is unbiased all the same, with weights that are negative at times.
    GridRecipe recipe = rough_recipe();
    const bool constant = GENERATE(true, false);
    if (constant)
        recipe.value = [](glm::ivec3) { return 0.7f; };
    TestGrid grid = make_test_grid(recipe);
    scale_majorants(grid, constant ? 0.5f : 0.2f);
    const Volume volume = absorber(constant ? 0.1 : 0.6);
    const TestScene scene = make_test_scene(grid.volume, volume, Filter::trilinear);
    const reference::Medium medium = reference::with_grid(make_reference_grid(grid), volume);
    const reference::Ray ray{{3, 7, -30}, glm::normalize(glm::dvec3(0.02, -0.01, 1.0))};
    const double T = reference::transmittance_quadrature(medium, ray, 0.0, infinity);
    CHECK(mean_p(scene, ray, 200000, T) > 1e-3);

    KernelRunner runner(transmittance_spv, scene.specialization, scene.kernel);
    runner.push.step_limit = 20000;
    runner.push.sample_end = 10000;
    const std::vector<RayInput> input = {{scene.to_render(ray.origin), ray.direction, 1, 0.0f, 0.0f, glm::vec3(1.0f)}};
    const auto outputs = runner.run<FlightOutput>(std::span<const RayInput>(input), 10000, 10000);
    CHECK(runner.counters().majorant_violations > 0u);
    CHECK(std::any_of(outputs.begin(), outputs.end(), [](const FlightOutput& f) { return f.weight.x < 0.0f; }));
}
