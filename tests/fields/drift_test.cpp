// Grids that drift with their velocities: against look-ups in the grid as it was, voxel by voxel.
#include <catch2/catch.hpp>
#include <cmath>
#include <nanovdb/NanoVDB.h>

#include "drift.h"
#include "error.h"
#include "shared/constants.h"
#include "support/statistics.h"
#include "support/test_grids.h"

using namespace vkvol;
using Catch::Contains;

namespace {

DensityField field_of(const GridRecipe& recipe, GridValues values = GridValues::numbers) {
    return make_density_field(make_grid_bytes(recipe), "test", values);
}

GridRecipe drifting_smoke(Storage storage = Storage::float32) {
    GridRecipe recipe;
    recipe.first = {-6, -3, 2};
    recipe.last = {19, 11, 14};
    recipe.value = [](glm::ivec3 ijk) { return float(0.2 + voxel_noise(ijk, 3)); };
    recipe.storage = storage;
    recipe.linear = glm::dmat3(0.5);
    recipe.translation = {3.0, -1.0, 2.0};
    return recipe;
}

GridRecipe velocities(glm::ivec3 first, glm::ivec3 last, const std::function<glm::vec3(glm::ivec3)>& velocity) {
    GridRecipe recipe = drifting_smoke();
    recipe.first = first;
    recipe.last = last;
    recipe.value = nullptr;
    recipe.color = velocity;
    return recipe;
}

double trilinear(const DensityField& field, glm::dvec3 p) {
    const glm::ivec3 i(glm::floor(p));
    const glm::dvec3 f = p - glm::floor(p);
    double sum = 0.0;
    for (int x = 0; x < 2; ++x)
        for (int y = 0; y < 2; ++y)
            for (int z = 0; z < 2; ++z)
                sum += (x ? f.x : 1.0 - f.x) * (y ? f.y : 1.0 - f.y) * (z ? f.z : 1.0 - f.z) *
                       double(field.value(i + glm::ivec3(x, y, z)));
    return sum;
}

// Compares everything near both.
template <class Expected> void check_voxels(const DensityField& moved, const Expected& expected) {
    double worst = 0.0;
    for (int x = -40; x <= 50; ++x)
        for (int y = -30; y <= 40; ++y)
            for (int z = -20; z <= 40; ++z)
                worsen(worst, std::abs(double(moved.value({x, y, z})) - expected(glm::ivec3(x, y, z))));
    CHECK(worst < 1e-5); // of values up to 1.2, and ways up to 20 voxels, in single precision
}

const glm::ivec3 wide_low(-48), wide_high(63);

} // namespace

TEST_CASE("what drifts by whole voxels is the grid, moved", "[cpu][motion][grid]") {
    for (const Storage storage : {Storage::float32, Storage::fp8}) {
        const DensityField field = field_of(drifting_smoke(storage));
        // Voxels are half a unit: 4, -6 and 3 units a second are 16, -24 and 12 voxels in two seconds.
        const DensityField wind =
            field_of(velocities(wide_low, wide_high, [](glm::ivec3) { return glm::vec3(4.0f, -6.0f, 3.0f); }),
                     GridValues::vectors);
        check_voxels(drifted(field, wind, 2.0), [&](glm::ivec3 v) { return field.value(v - glm::ivec3(16, -24, 12)); });
        check_voxels(drifted(field, wind, -1.0), [&](glm::ivec3 v) { return field.value(v + glm::ivec3(8, -12, 6)); });
        const DensityField same = drifted(field, wind, 0.0);
        CHECK(same.bytes.data() == field.bytes.data());
        CHECK(drifted(field, wind, 2.0).index_to_world == field.index_to_world);
    }
}

TEST_CASE("velocities are looked up where they are", "[cpu][motion][grid]") {
    const DensityField field = field_of(drifting_smoke());
    const auto swirl = [](glm::ivec3 v) {
        return glm::vec3(0.3f * float(v.y) + 0.7f, -0.25f * float(v.x), 0.5f * float(voxel_noise(v, 5)) - 0.2f);
    };
    const DensityField wind = field_of(velocities(wide_low, wide_high, swirl), GridValues::vectors);
    REQUIRE(wind.color({3, -2, 5}).x == Approx(0.1)); // negative ones count: 0.3 * -2 + 0.7
    REQUIRE(wind.color({3, -2, 5}).y == Approx(-0.75));
    check_voxels(drifted(field, wind, 0.6),
                 [&](glm::ivec3 v) { return trilinear(field, glm::dvec3(v) - 0.6 / 0.5 * glm::dvec3(swirl(v))); });

    // On a coarser grid, turned by a quarter: the same wind, which is linear in space, at the same places.
    GridRecipe coarse = velocities({-30, -30, -30}, {30, 30, 30}, [&](glm::ivec3 v) {
        const glm::dvec3 world =
            glm::dmat3(0, 1.5, 0, -1.5, 0, 0, 0, 0, 1.5) * glm::dvec3(v) + glm::dvec3(1.0, 2.0, 3.0);
        return glm::vec3(0.2 * world.y + 0.1, -0.3 * world.x, 0.05 * world.z);
    });
    coarse.linear = glm::dmat3(0, 1.5, 0, -1.5, 0, 0, 0, 0, 1.5);
    coarse.translation = {1.0, 2.0, 3.0};
    check_voxels(drifted(field, field_of(coarse, GridValues::vectors), 0.6), [&](glm::ivec3 v) {
        const glm::dvec3 world = 0.5 * glm::dvec3(v) + glm::dvec3(3.0, -1.0, 2.0);
        const glm::dvec3 wind_there(0.2 * world.y + 0.1, -0.3 * world.x, 0.05 * world.z);
        return trilinear(field, glm::dvec3(v) - 0.6 / 0.5 * wind_there);
    });
}

// Each component in the middle of its lower face: there, half a voxel before the voxel's middle along its own axis.
TEST_CASE("velocities on faces are looked up there", "[cpu][motion][grid]") {
    const DensityField field = field_of(drifting_smoke());
    const auto wind_at = [](glm::dvec3 v) { return glm::dvec3(0.5 * v.x + 1.0, -0.25 * v.y, 0.125 * v.z - 0.5); };
    GridBytes bytes = make_grid_bytes(velocities(wide_low, wide_high, [&](glm::ivec3 v) {
        glm::vec3 wind;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 face(v);
            face[axis] -= 0.5;
            wind[axis] = float(wind_at(face)[axis]);
        }
        return wind;
    }));
    reinterpret_cast<nanovdb::GridData*>(bytes.edit())->mGridClass = nanovdb::GridClass::Staggered;
    check_voxels(drifted(field, make_density_field(std::move(bytes), "test", GridValues::vectors), 0.25),
                 [&](glm::ivec3 v) { return trilinear(field, glm::dvec3(v) - 0.5 * wind_at(v)); });
}

TEST_CASE("nothing moves where there is no velocity", "[cpu][motion][grid]") {
    const DensityField field = field_of(drifting_smoke());
    const DensityField wind =
        field_of(velocities({0, 0, 0}, {5, 40, 40}, [](glm::ivec3) { return glm::vec3(0.0f, 2.5f, 0.0f); }),
                 GridValues::vectors);
    check_voxels(drifted(field, wind, 1.0), [&](glm::ivec3 v) {
        const bool blows = v.x >= 0 && v.x <= 5 && v.y >= 0 && v.y <= 40 && v.z >= 0 && v.z <= 40;
        return field.value(v - glm::ivec3(0, blows ? 5 : 0, 0));
    });
}

TEST_CASE("colours drift as densities do", "[cpu][motion][grid]") {
    GridRecipe recipe = drifting_smoke();
    recipe.color = [](glm::ivec3 v) { return glm::vec3(voxel_noise(v, 1), voxel_noise(v, 2), voxel_noise(v, 3)); };
    const DensityField field = field_of(recipe, GridValues::numbers_or_colors);
    const DensityField wind = field_of(
        velocities(wide_low, wide_high, [](glm::ivec3) { return glm::vec3(-1.0f, 0.5f, 0.0f); }), GridValues::vectors);
    const DensityField moved = drifted(field, wind, 3.0);
    REQUIRE(moved.type == GRID_COLOR);
    for (int x = -20; x < 30; ++x)
        CHECK(moved.color({x, 4, 7}) == field.color({x + 6, 1, 7}));
    // An albedo goes on beyond its box as it is at its faces, and keeps it.
    const DensityField tint = drifted(field, wind, 3.0, true);
    CHECK(tint.voxel_min == field.voxel_min);
    CHECK(tint.voxel_max == field.voxel_max);
    for (int x = field.voxel_min.x; x <= field.voxel_max.x; ++x)
        CHECK(tint.color({x, 4, 7}) == field.color({std::min(x + 6, field.voxel_max.x), 1, 7}));
    const DensityField barely = drifted(field, wind, 1e-4, true); // not a thousandth of the colour beyond it
    CHECK(barely.color(field.voxel_max).x == Approx(field.color(field.voxel_max).x).margin(1e-3));
}

// Where a grid's values are mapped, its box is where the medium is.
TEST_CASE("the box of what drifts does not shrink", "[cpu][motion][grid]") {
    GridRecipe recipe = drifting_smoke();
    recipe.background = -1.0f; // so that zeros are active
    recipe.value = [](glm::ivec3 v) { return v.x > 3 && v.x < 8 ? 1.0f : 0.0f; };
    DensityField field = field_of(recipe);
    const DensityField wind = field_of(
        velocities(wide_low, wide_high, [](glm::ivec3) { return glm::vec3(0.5f, 0.0f, 0.0f); }), GridValues::vectors);
    const DensityField moved = drifted(field, wind, 1.0);
    CHECK(moved.voxel_min == field.voxel_min);
    CHECK(moved.voxel_max == field.voxel_max);
    CHECK(moved.value({8, 0, 5}) == Approx(1.0));
}

TEST_CASE("what is said of velocities that are none", "[cpu][motion][grid]") {
    const DensityField field = field_of(drifting_smoke());
    CHECK_THROWS_WITH(field_of(drifting_smoke(), GridValues::vectors), Contains("velocities are vectors (Vec3f)"));
    const DensityField storm = field_of(
        velocities(wide_low, wide_high, [](glm::ivec3) { return glm::vec3(1e5f, 0.0f, 0.0f); }), GridValues::vectors);
    CHECK_THROWS_WITH(drifted(field, storm, 1.0), Contains("2e+05 voxels") && Contains("raise framesPerSecond"));
    // Far from it.
    const DensityField near = field_of(drifting_smoke());
    const DensityField gale =
        field_of(velocities({-700, -700, -700}, {-700, -700, -700}, [](glm::ivec3) { return glm::vec3(1900.0f); }),
                 GridValues::vectors);
    CHECK(drifted(near, gale, 1.0).voxel_max == near.voxel_max); // nothing blows near it
}
