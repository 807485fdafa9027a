// Maps from a grid's values: what they make of a value, of all in an interval, and bounds of them in majorant cells.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "majorant_grid.h"
#include "support/test_medium.h"
#include "tests/reference/mapped.h"
#include "value_map.h"

using namespace vkvol;

namespace {

// Points at random: some of them steps, the first at 0 or beyond, some going on to rise.
ValueMap random_map(std::mt19937& engine) {
    std::uniform_real_distribution<double> uniform;
    ValueMap map;
    double value = engine() % 2 ? 0.0 : 0.2 * uniform(engine);
    for (unsigned left = 1 + engine() % 9; left > 0; --left) {
        const bool step = !map.points.empty() && engine() % 4 == 0 &&
                          (map.points.size() < 2 || map.points[map.points.size() - 2].value != value);
        value += step || map.points.empty() ? 0.0 : 0.01 + 0.3 * uniform(engine);
        map.points.push_back({value, engine() % 4 ? 2.0 * uniform(engine) : 0.0});
    }
    map.rise = engine() % 2 ? uniform(engine) : 0.0;
    return map;
}

// As a kernel finds it, in single precision.
double of_table(const std::vector<shared::MapKnot>& knots, float value) {
    const auto after =
        std::find_if(knots.begin(), knots.end(), [&](const shared::MapKnot& knot) { return knot.value > value; });
    const shared::MapKnot& knot = *std::prev(after);
    return std::max(knot.density + (value - knot.value) * knot.density_slope, 0.0f);
}

} // namespace

TEST_CASE("a map is linear between its points, and goes on as they end", "[cpu][value_map]") {
    const ValueMap map = bumpy_map();
    CHECK(mapped_density({}, 0.7) == 0.7);
    CHECK(mapped_density(map, 0.0) == 0.0);
    CHECK(mapped_density(map, 0.175) == Approx(0.6));
    CHECK(mapped_density(map, 0.49999999) == Approx(0.2).epsilon(1e-6));
    CHECK(mapped_density(map, 0.5) == 0.8); // of two points of one value the latter counts
    CHECK(mapped_density(map, 1.2) == 0.6);
    CHECK(mapped_density(map, 3.2) == Approx(1.6));
}

TEST_CASE("maps, their tables and the reference agree", "[cpu][value_map]") {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform(0.0, 3.0);
    for (int i = 0; i < 2000; ++i) {
        const ValueMap map = random_map(engine);
        std::vector<shared::MapKnot> knots = make_knots(map);
        REQUIRE((knots.size() & (knots.size() - 1)) == 0);
        pad_knots(knots, 32); // as the longest table of a scene has
        for (int k = 0; k < 50; ++k) {
            const float value = float(uniform(engine));
            const double expected = reference::mapped(map, value).density;
            REQUIRE(mapped_density(map, value) == Approx(expected).margin(1e-12));
            // Densities end at 4, slopes at 200: a value, its knot and their difference round, the slope and the
            // product, the density and the sum.
            REQUIRE(of_table(knots, value) == Approx(expected).margin((3.0 * 200.0 * 3.0 + 4.0 * 4.0) * 0x1p-24));
        }
    }
}

TEST_CASE("extrema of a map over an interval are all that it has there, and none beyond", "[cpu][value_map]") {
    std::mt19937 engine(2);
    std::uniform_real_distribution<double> uniform(0.0, 3.0);
    for (int i = 0; i < 2000; ++i) {
        const ValueMap map = random_map(engine);
        const auto [low, high] = std::minmax({uniform(engine), uniform(engine)});
        const DensityRange range = mapped_range(map, low, high);
        double least = 1e300, most = 0.0;
        for (int k = 0; k <= 1000; ++k) {
            const double density = reference::mapped(map, low + (high - low) * k / 1000.0).density;
            REQUIRE(density >= range.least);
            REQUIRE(density <= range.most);
            least = std::min(least, density);
            most = std::max(most, density);
        }
        for (const MapPoint& point : map.points)
            if (point.value > low && point.value < high) {
                least = std::min(least, point.density);
                most = std::max(most, point.density);
            }
        // Off by what the widened interval may add: 1e-6 of a value up to 3, at slopes up to 200.
        CHECK(range.least >= least - 6.1e-4);
        CHECK(range.most <= most + 6.1e-4);
    }
    const DensityRange at_step = mapped_range(bumpy_map(), 0.5, 0.5); // rounding may come to either side
    CHECK(at_step.least <= 0.2 + 1e-5);
    CHECK(at_step.most == 0.8);
    CHECK(mapped_range(bumpy_map(), 0.0, 0.0).most == 0.0); // of nothing comes nothing
}

TEST_CASE("majorants and controls bound what interpolated values are mapped to", "[cpu][value_map][majorant]") {
    const int cell = GENERATE(4, 8, 5);
    const double sigma_t = GENERATE(0.0, 0.5); // controls that are the least, or the mean
    GridRecipe recipe = larger_recipe(Storage::float32);
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> uniform;
    const TestGrid grid = make_test_grid(recipe);
    const reference::Grid exact = make_reference_grid(grid);
    const glm::dvec3 low = glm::dvec3(grid.voxel_min) - 1.0, high = glm::dvec3(grid.voxel_max) + 1.0;
    for (int k = 0; k < 6; ++k) {
        const ValueMap map = k == 0 ? bumpy_map() : random_map(engine);
        const MajorantGrid m = make_majorant_grid(grid.field(), cell, map);
        const auto controls = make_controls(grid.field(), m, sigma_t, map);
        int violations = 0, loose = 0;
        std::vector<double> met(m.bounds.size(), 0.0);
        for (int i = 0; i < 400'000; ++i) {
            const glm::dvec3 p = low + glm::dvec3(uniform(engine), uniform(engine), uniform(engine)) * (high - low);
            const glm::ivec3 at(glm::floor((p - glm::dvec3(m.origin)) / double(cell)));
            const std::size_t index = (std::size_t(at.x) * m.dims.y + at.y) * m.dims.z + at.z;
            const double density = reference::mapped(map, exact.trilinear(p)).density;
            violations += !(density <= m.bounds[index] * (1.0 + 1e-7));
            violations += !(std::abs(density - controls[index].control) <= controls[index].residual);
            met[index] = std::max(met[index], density);
        }
        CHECK(violations == 0);
        for (std::size_t i = 0; i < met.size(); ++i)
            loose += met[i] < 0.5 * m.bounds[i];
        CHECK(loose < int(met.size()) / 4); // points are random, and corners are rare
    }
}
