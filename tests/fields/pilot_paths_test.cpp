// Pilot paths choose what costs the fewest steps: the cells' size, leaps, steps in a turn.
#include <catch2/catch.hpp>
#include <numeric>

#include "empty_space.h"
#include "pilot_paths.h"
#include "support/test_grids.h"

using namespace vkvol;

TEST_CASE("left to itself the cell has the size over which paths take the fewest steps", "[cpu][majorant]") {
    const TestGrid grid = make_test_grid(larger_recipe(Storage::float32));
    PilotScene scene;
    scene.eye = glm::dvec3(grid.voxel_min) - glm::dvec3(30.0, 50.0, 20.0);
    scene.light = glm::normalize(glm::dvec3(1.0, 2.0, -0.5));
    scene.sigma_t = GENERATE(0.001, 0.05, 1.0, 20.0);
    scene.albedo = 0.9;
    scene.g = GENERATE(0.0, 0.7);
    const std::vector<PilotSegment> segments = pilot_paths(grid.field(), make_majorant_grid(grid.field(), 4), scene);
    REQUIRE(segments.size() >= 256);
    const auto cost = [&](const MajorantGrid& m) {
        const std::vector<double> steps = pilot_steps(segments, m, scene.sigma_t);
        return std::accumulate(steps.begin(), steps.end(), 0.0) * (m.leaps ? leap_cost : 1.0);
    };
    const MajorantGrid chosen = choose_majorant_grid(grid.field(), scene);
    CHECK(chosen.segment_steps == pilot_steps(segments, chosen, scene.sigma_t));
    CHECK(choose_majorant_grid(grid.field(), scene, 5).cell == 5);
    for (const int cell : {4, 8, 16, 32, 64}) {
        CAPTURE(cell, scene.sigma_t);
        MajorantGrid m = make_majorant_grid(grid.field(), cell);
        CHECK(cost(chosen) <= cost(m));
        m.leaps = true;
        CHECK(cost(chosen) <= cost(m));
        if (chosen.cell == cell) {
            CHECK(chosen.origin == m.origin);
            CHECK(chosen.dims == m.dims);
            CHECK(chosen.bounds == m.bounds);
        }
    }
}

TEST_CASE("steps along a segment are the majorant's optical depth and the cells crossed", "[cpu][majorant]") {
    const auto steps_of = [](const PilotSegment& segment, const MajorantGrid& cells) {
        return pilot_steps({segment}, cells, 0.5).at(0);
    };
    MajorantGrid cells{8, {-3, 2, 5}, {3, 1, 1}, {1.0f, 0.0f, 4.0f}};
    const double whole = 0.5 * (8.0 * 1.0 + 4.0 * 4.0);
    const PilotSegment across{{-3.0, 4.0, 7.0}, {1.0, 0.0, 0.0}, 20.0};
    PilotSegment collides = across;
    collides.collides = true; // in the last cell, which is not crossed
    CHECK(steps_of(across, cells) == Approx(whole + 3.0));
    CHECK(steps_of(collides, cells) == Approx(whole + 2.0));
    // Backwards from a face: the cell it begins in counts, though it is left at once.
    const PilotSegment back{{13.0, 4.0, 7.0}, {-1.0, 0.0, 0.0}, 10.0};
    CHECK(steps_of(back, cells) == Approx(0.5 * 2.0 * 1.0 + 3.0));
    // Empty cells are passed together, or one by one.
    MajorantGrid row{8, {0, 0, 0}, {9, 1, 1}, std::vector<float>(9, 0.0f)};
    row.bounds[8] = 1.0f;
    const PilotSegment along{{0.0, 4.0, 4.0}, {1.0, 0.0, 0.0}, 70.0};
    CHECK(steps_of(along, row) == Approx(0.5 * 6.0 + 9.0));
    row.leaps = true; // cell 0 reaches to 7, 8 is not empty
    CHECK(steps_of(along, row) == Approx(0.5 * 6.0 + 2.0));
}

TEST_CASE("a turn has as many steps as lanes seldom wait for", "[cpu][majorant]") {
    CHECK(best_steps_per_turn({}) == 4);
    CHECK(best_steps_per_turn({1.0, 1.2, 1.9}) == 2);
    CHECK(best_steps_per_turn({2.5, 3.0, 3.0}) == 3);
    CHECK(best_steps_per_turn({40.0, 2.0, 25.0}) == 4);
}

TEST_CASE("walks leap where that takes fewer steps, and the scene's can", "[cpu][majorant]") {
    PilotScene scene;
    scene.eye = {-100.0, 20.0, 10.0};
    scene.sigma_t = 0.5;
    scene.albedo = 0.9;
    const TestGrid sparse = make_test_grid(sparse_recipe()), full = make_test_grid(larger_recipe(Storage::float32));
    CHECK(choose_majorant_grid(sparse.field(), scene).leaps);
    CHECK_FALSE(choose_majorant_grid(full.field(), scene).leaps);
    scene.leaps = false;
    CHECK_FALSE(choose_majorant_grid(sparse.field(), scene).leaps);
}

TEST_CASE("a pilot ends where majorants are far too high", "[cpu][majorant]") {
    // One voxel of density 1e9 makes every cell's bound a billion: the path's own end is out of reach.
    GridRecipe spike{{0, 0, 0}, {40, 40, 40}, nullptr, Storage::float32};
    spike.value = [](glm::ivec3 i) { return i == glm::ivec3(20) ? 1e9f : 1e-9f; };
    const TestGrid grid = make_test_grid(spike);
    PilotScene scene;
    scene.sigma_t = 1.0;
    scene.eye = {-50.0, 20.0, 20.0};
    CHECK(choose_majorant_grid(grid.field(), scene).cell == 4);
}
