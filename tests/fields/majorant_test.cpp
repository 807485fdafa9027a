// Majorants bound the density and no more than need be.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "majorant_grid.h"
#include "support/test_grids.h"

using namespace vkvol;

namespace {

// The largest voxel among those that interpolation inside the closed cell touches, looked up one by one.
float brute_force_bound(const TestGrid& grid, glm::ivec3 cell) {
    const MajorantGrid& m = grid.majorants();
    const glm::ivec3 low = m.origin + cell * m.cell;
    float bound = 0.0f;
    for (int z = low.z; z <= low.z + m.cell; ++z)
        for (int y = low.y; y <= low.y + m.cell; ++y)
            for (int x = low.x; x <= low.x + m.cell; ++x)
                bound = std::max(bound, grid.voxel({x, y, z}));
    return bound;
}

} // namespace

TEST_CASE("majorants are the largest voxel that interpolation in the cell touches", "[cpu][majorant]") {
    const int cell = GENERATE(4, 8, 16, 5);
    const Storage storage = GENERATE(from_range(std::begin(all_storages), std::end(all_storages)));
    CAPTURE(cell, storage_name(storage));
    GridRecipe recipe = larger_recipe(storage);
    recipe.cell = cell;
    const TestGrid grid = make_test_grid(recipe);
    const MajorantGrid& m = grid.majorants();
    REQUIRE(m.cell == cell);
    REQUIRE(m.origin == grid.voxel_min - 1);
    for (int axis = 0; axis < 3; ++axis) { // the cells reach from one voxel before the box to one beyond, no further
        CHECK(m.origin[axis] + m.dims[axis] * cell >= grid.voxel_max[axis] + 1);
        CHECK(m.origin[axis] + (m.dims[axis] - 1) * cell < grid.voxel_max[axis] + 1);
    }
    for (int x = 0; x < m.dims.x; ++x)
        for (int y = 0; y < m.dims.y; ++y)
            for (int z = 0; z < m.dims.z; ++z) {
                CAPTURE(x, y, z);
                REQUIRE(bound_of(m, {x, y, z}) == Approx(brute_force_bound(grid, {x, y, z})).epsilon(0x1p-22));
            }
}

TEST_CASE("majorants count tiles, backgrounds and blocks of 0", "[cpu][majorant]") {
    GridRecipe recipe;
    recipe.first = {-24, -8, 0};
    recipe.last = {31, 23, 23};
    recipe.background = GENERATE(0.0f, 0.375f);
    recipe.cell = GENERATE(8, 5);
    recipe.value = [](glm::ivec3 i) { // whole blocks of 0, of the background, of another value, and noise
        const int kind = ((i.x >> 3) + 2 * (i.y >> 3) + 3 * (i.z >> 3)) & 3;
        return kind == 0 ? 0.0f : kind == 1 ? 0.375f : kind == 2 ? 0.5f : float(voxel_noise(i, 2));
    };
    const TestGrid grid = make_test_grid(recipe);
    const MajorantGrid& m = grid.majorants();
    for (int x = 0; x < m.dims.x; ++x)
        for (int y = 0; y < m.dims.y; ++y)
            for (int z = 0; z < m.dims.z; ++z)
                REQUIRE(bound_of(m, {x, y, z}) == brute_force_bound(grid, {x, y, z}));
}

TEST_CASE("majorants bound the interpolated density at random points", "[cpu][majorant]") {
    const int cell = GENERATE(4, 8, 16, 5);
    GridRecipe recipe = larger_recipe(Storage::float32);
    recipe.cell = cell;
    const TestGrid grid = make_test_grid(recipe);
    const reference::Grid exact = make_reference_grid(grid);
    const MajorantGrid& m = grid.majorants();
    const glm::dvec3 low = glm::dvec3(grid.voxel_min) - 1.0, high = glm::dvec3(grid.voxel_max) + 1.0;
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> uniform;
    int violations = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const glm::dvec3 u(uniform(engine), uniform(engine), uniform(engine));
        const glm::dvec3 p = low + u * (high - low);
        const glm::ivec3 at(glm::floor((p - glm::dvec3(m.origin)) / double(cell)));
        violations += !(exact.trilinear(p) <= bound_of(m, at) * (1.0 + 1e-14));
    }
    CHECK(violations == 0);
}

TEST_CASE("majorant grids have no more than 2^24 cells", "[cpu][majorant]") {
    DensityField vast;
    vast.active_voxels = 2;
    vast.voxel_max = {2100, 2100, 2100}; // 263^3 cells of 8 voxels are more than 2^24
    CHECK(make_majorant_grid(vast, 4).cell == 16);
}
