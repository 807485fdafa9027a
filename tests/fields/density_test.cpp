// Density lookups of host and device against NanoVDB's own, for every type of grid.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "kernels/test_items.h"
#include "lookup.spv.h"
#include "support/scenes.h"
#include "support/test_grids.h"
#include "support/test_scene.h"

using namespace vkvol;
using shared::DensityInput;
using shared::DensityOutput;

namespace {

constexpr float largest_tap = 1.0f - 0x1p-24f;

// Host and device decode a quantised voxel as code * quantum + minimum; a fused multiply-add or its absence moves the
// result by half an ulp of the product and half of the sum, both below the largest value. Floats are copied.
double voxel_tolerance(const TestGrid& grid) {
    return grid.field().type == GRID_FLOAT ? 0.0 : 0x1p-23 * grid.highest;
}

// Trilinear interpolation: the fractions p - floor(p) are exact. Each mix(a, b, f) = a (1 - f) + b f rounds 1 - f, two
// products and a sum, at most 4 * 2^-24 of the largest corner; three of them follow one another.
double trilinear_tolerance(const TestGrid& grid) {
    return voxel_tolerance(grid) + 12 * 0x1p-24 * grid.highest;
}

// The next smaller number a device must know: Vulkan lets it take subnormal ones for 0.
float just_below(float x) {
    return x == 0.0f ? -std::numeric_limits<float>::min() : std::nextafter(x, -1e9f);
}

// Voxel centres, faces, edges, points between, beyond the box and far away, at all signs of index.
std::vector<glm::vec3> probe_points(const TestGrid& grid, int count) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> uniform;
    const auto random = [&] { return glm::dvec3(uniform(engine), uniform(engine), uniform(engine)); };
    const glm::dvec3 low = glm::dvec3(grid.voxel_min) - 3.0, high = glm::dvec3(grid.voxel_max) + 3.0;
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) {
        glm::vec3 p = low + random() * (high - low);
        for (int axis = 0; axis < 3; ++axis) {
            const double kind = uniform(engine);
            if (kind < 0.2)
                p[axis] = std::round(p[axis]); // the plane of voxel centres
            else if (kind < 0.3)
                p[axis] = std::round(p[axis]) + 0.5f; // the face between two voxels
            else if (kind < 0.35)
                p[axis] = just_below(std::round(p[axis]));
            else if (kind < 0.4) // the border of the box, and of where interpolation reaches
                p[axis] = kind < 0.375 ? grid.voxel_min[axis] - float(kind < 0.36)
                                       : grid.voxel_max[axis] + float(kind < 0.39);
        }
        points.push_back(p);
    }
    for (const float far : {100.0f, -100.0f, 5000.0f, -5000.0f, 1e6f, -1e6f})
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 p = 0.5f * glm::vec3(grid.voxel_min + grid.voxel_max);
            p[axis] += far;
            points.push_back(p);
        }
    return points;
}

KernelRunner make_lookup(const TestGrid& grid, Filter filter = Filter::trilinear) {
    const TestScene scene = make_test_scene(grid.volume, {}, filter);
    return KernelRunner(lookup_spv, scene.specialization, scene.kernel);
}

void check_lookups(const TestGrid& grid, int count = 20000) {
    std::vector<DensityInput> inputs;
    for (const glm::vec3 p : probe_points(grid, count))
        inputs.push_back({p, glm::vec3(0.0f)});
    const auto outputs = make_lookup(grid).run<DensityOutput>(inputs);
    const double one = voxel_tolerance(grid), eight = trilinear_tolerance(grid);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::vec3 p = inputs[i].p;
        const DensityOutput& o = outputs[i];
        INFO("at " << p.x << ' ' << p.y << ' ' << p.z);
        REQUIRE(std::abs(o.voxel - double(grid.voxel(glm::floor(p)))) <= one);
        REQUIRE(std::abs(o.nearest - double(grid.voxel(glm::floor(p + 0.5f)))) <= one);
        REQUIRE(std::abs(o.trilinear - grid.trilinear(p)) <= eight);
        REQUIRE(o.filtered == o.trilinear);
    }
}

// The renderer's own host lookup, at every voxel of the box and around it.
void check_host(const TestGrid& grid) {
    for (int z = grid.voxel_min.z - 2; z <= grid.voxel_max.z + 2; ++z)
        for (int y = grid.voxel_min.y - 2; y <= grid.voxel_max.y + 2; ++y)
            for (int x = grid.voxel_min.x - 2; x <= grid.voxel_max.x + 2; ++x) {
                const glm::ivec3 ijk(x, y, z);
                INFO("at " << x << ' ' << y << ' ' << z);
                REQUIRE(std::abs(grid.field().value(ijk) - grid.voxel(ijk)) <= voxel_tolerance(grid));
            }
}

// 40 x 20 x 20 voxels whose blocks need 1, 2, 4, 8 and 16 bits per value in an FpN grid.
GridRecipe graded_recipe(Storage storage) {
    GridRecipe recipe;
    recipe.storage = storage;
    recipe.first = {-17, -9, -4};
    recipe.last = {22, 10, 15};
    recipe.value = [](glm::ivec3 i) {
        const double noise = voxel_noise(i, 3);
        switch ((i.x >> 3) + 3) {
        case 0:
            return 0.5f;
        case 1:
            return noise < 0.5 ? 0.25f : 0.75f;
        case 2:
            return static_cast<float>(std::floor(noise * 4.0) * 0.25);
        case 3:
            return static_cast<float>(0.1 + 0.02 * noise);
        case 4:
            return static_cast<float>(noise);
        default:
            return static_cast<float>(40.0 * noise);
        }
    };
    return recipe;
}

} // namespace

TEST_CASE("lookups equal NanoVDB's for every type of grid", "[gpu][density]") {
    const Storage storage = GENERATE(from_range(std::begin(all_storages), std::end(all_storages)));
    CAPTURE(storage_name(storage));
    const TestGrid grid = make_test_grid(graded_recipe(storage));
    CHECK(grid.field().type == static_cast<int>(storage));
    CHECK(grid.field().voxel_min == grid.voxel_min);
    CHECK(grid.field().voxel_max == grid.voxel_max);
    check_host(grid);
    check_lookups(grid);
}

TEST_CASE("interpolation equals NanoVDB's sampler where the grid has no border", "[gpu][density]") {
    const Storage storage = GENERATE(from_range(std::begin(all_storages), std::end(all_storages)));
    CAPTURE(storage_name(storage));
    const TestGrid grid = make_test_grid(graded_recipe(storage));
    std::vector<DensityInput> inputs;
    for (const glm::vec3 p : probe_points(grid, 5000))
        inputs.push_back({p, glm::vec3(0.0f)});
    const auto outputs = make_lookup(grid).run<DensityOutput>(inputs);
    // The sampler computes in single precision too, so both errors add.
    for (std::size_t i = 0; i < inputs.size(); ++i)
        if (glm::ivec3 low = glm::floor(inputs[i].p); grid.in_box(low) && grid.in_box(low + 1))
            REQUIRE(std::abs(outputs[i].trilinear - grid.sampler(inputs[i].p)) <= 2.0 * trilinear_tolerance(grid));
}

TEST_CASE("FpN grids in the tests have every width of code", "[cpu][density]") {
    // Otherwise the comparison above would show less than it claims. One leaf's flags hold log2 of its bits per value.
    const TestGrid grid = make_test_grid(graded_recipe(Storage::fpn));
    std::vector<int> leaves(5, 0);
    for (const std::uint32_t entry : grid.field().leaf_table)
        if (entry & 1u)
            ++leaves.at(std::to_integer<unsigned>(grid.field().bytes.data()[(entry >> 1) * 4 + 15]) >> 5);
    for (int log2 = 0; log2 < 5; ++log2) {
        CAPTURE(log2);
        CHECK(leaves[log2] > 0);
    }
}

TEST_CASE("a stochastic tap takes each corner with its trilinear weight", "[gpu][density]") {
    const TestGrid grid = make_test_grid(rough_recipe());
    // A corner's upper neighbour along an axis is taken iff tap < f, so for tap uniform on multiples of 2^-24 with the
    // probability f, up to 2^-24. Enumerate both sides of each threshold: all eight corners, at the very limits of
    // their ranges; their mean under those probabilities is the trilinear value by definition.
    std::vector<DensityInput> inputs;
    std::vector<glm::ivec3> expected;
    for (const glm::vec3 p : probe_points(grid, 2000)) {
        const glm::vec3 base = glm::floor(p), f = p - base;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
            glm::vec3 tap;
            bool possible = true;
            for (int axis = 0; axis < 3; ++axis) {
                tap[axis] = c[axis] == 1 ? std::nextafter(f[axis], 0.0f) : std::min(f[axis], largest_tap);
                possible = possible && (c[axis] == 0 || f[axis] > 0.0f) && (c[axis] == 1 || f[axis] < largest_tap);
            }
            for (const glm::vec3 t : {tap, glm::mix(glm::vec3(largest_tap), glm::vec3(0.0f), glm::vec3(c))}) {
                if (!possible)
                    continue;
                inputs.push_back({p, t});
                expected.push_back(glm::ivec3(base) + c);
            }
        }
    }
    REQUIRE(inputs.size() > 10000);
    const auto outputs = make_lookup(grid, Filter::stochastic).run<DensityOutput>(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        REQUIRE(outputs[i].stochastic == grid.voxel(expected[i]));
        REQUIRE(outputs[i].filtered == outputs[i].stochastic);
    }
    const auto nearest = make_lookup(grid, Filter::nearest).run<DensityOutput>(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        REQUIRE(nearest[i].filtered == nearest[i].nearest);
}

TEST_CASE("tiles of every level count as voxels", "[gpu][density]") {
    SECTION("a block of 8^3") {
        GridRecipe recipe;
        recipe.first = {-12, -12, -12};
        recipe.last = {19, 19, 19};
        recipe.value = [](glm::ivec3 i) { // whole blocks of one value beside noise
            return (i.x >> 3) % 2 == 0 ? 0.5f + 0.25f * (i.y >> 3) * (i.y >> 3) : float(voxel_noise(i, 4));
        };
        recipe.storage = GENERATE(Storage::float32, Storage::fp8, Storage::fpn);
        const TestGrid grid = make_test_grid(recipe);
        CHECK(std::count_if(grid.field().leaf_table.begin(), grid.field().leaf_table.end(),
                            [](std::uint32_t entry) { return !(entry & 1u); }) > 8);
        check_host(grid);
        check_lookups(grid);
    }
    SECTION("a block of 128^3") {
        GridRecipe recipe;
        recipe.first = {-128, 0, 0};
        recipe.last = {5, 127, 127};
        recipe.value = [](glm::ivec3 i) {
            return i.x < 0 ? 0.75f : i.y < 3 && i.z < 3 ? float(voxel_noise(i, 5)) : 0.0f;
        };
        recipe.storage = GENERATE(Storage::float32, Storage::fp4);
        const TestGrid grid = make_test_grid(recipe);
        CHECK(grid.field().bytes.size() < 1'000'000);
        check_lookups(grid);
    }
    SECTION("a block of 4096^3, and a grid made of tiles only") {
        GridRecipe recipe;
        recipe.first = {4090, 0, 0};
        recipe.last = {8200, 0, 0};
        recipe.value = [](glm::ivec3 i) { return i.x < 4093 || i.x > 8195 ? 1.5f : i.x == 5000 ? 2.0f : 0.0f; };
        const TestGrid grid = make_test_grid(with_root_tile(make_grid_bytes(recipe), {5000, 0, 0}, 0.625f));
        CHECK(grid.voxel({5000, 0, 0}) == 0.625f);
        CHECK(grid.voxel({8191, 0, 0}) == 0.625f);
        CHECK(grid.voxel({4090, 0, 0}) == 1.5f);
        CHECK(grid.voxel({4095, 0, 0}) == 0.0f);
        check_host(grid);
        check_lookups(grid);
    }
}

TEST_CASE("a background other than 0 fills holes, and ends at the box", "[gpu][density]") {
    GridRecipe recipe = rough_recipe();
    recipe.background = 0.375f;
    recipe.value = [](glm::ivec3 i) { // whole blocks of background, single voxels of it, and voxels of 0
        return i.x >= 0 && i.x < 8 && i.y >= 8 ? 0.375f : voxel_noise(i, 6) < 0.3 ? 0.375f : float(voxel_noise(i, 7));
    };
    const TestGrid grid = make_test_grid(recipe);
    CHECK(grid.accessor({100, 100, 100}) == 0.375f);
    CHECK(grid.field().value({100, 100, 100}) == 0.0f);
    CHECK(grid.voxel({2, 10, 3}) == 0.375f);
    check_host(grid);
    check_lookups(grid);
}

TEST_CASE("values that are no density count as 0 and are counted", "[gpu][density][hard]") {
    GridRecipe recipe = rough_recipe();
    int bad = 0;
    const auto value = [](glm::ivec3 i) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const double noise = voxel_noise(i, 8);
        return noise < 0.05   ? std::numeric_limits<float>::quiet_NaN()
               : noise < 0.10 ? infinity
               : noise < 0.15 ? -infinity
               : noise < 0.20 ? -1.5f
                              : static_cast<float>(noise);
    };
    recipe.value = value;
    for (int z = recipe.first.z; z <= recipe.last.z; ++z)
        for (int y = recipe.first.y; y <= recipe.last.y; ++y)
            for (int x = recipe.first.x; x <= recipe.last.x; ++x)
                bad += voxel_noise({x, y, z}, 8) < 0.20;
    const TestGrid grid = make_test_grid(recipe);
    CHECK(grid.field().cleaned == static_cast<std::uint64_t>(bad));
    check_host(grid);
    check_lookups(grid);
}

// As of exports in Hounsfield's units: what no voxel has was never to be seen.
TEST_CASE("a background that is no density is no voxel that was cleaned", "[cpu][density]") {
    GridRecipe recipe = rough_recipe();
    recipe.first = glm::ivec3(8);
    recipe.last = glm::ivec3(13); // a leaf's, but for some
    recipe.background = -1000.0f;
    const TestGrid grid = make_test_grid(recipe);
    CHECK(grid.field().cleaned == 0);
    CHECK(grid.field().background == 0.0f);
}

TEST_CASE("grids of one name are told apart by numbers", "[cpu][density]") {
    std::vector<GridRecipe> recipes(3, rough_recipe());
    for (int i = 0; i < 3; ++i)
        recipes[std::size_t(i)].value = [i](glm::ivec3) { return i + 1.0f; };
    const GridFile file = write_grids(recipes);
    CHECK(load_density_field(file).max_value() == 1.0f);
    CHECK(load_density_field({file.path, "density[1]"}).max_value() == 2.0f);
    CHECK(load_density_field({file.path, "density[2]"}).max_value() == 3.0f);
    for (GridRecipe& recipe : recipes)
        recipe.name = "";
    const GridFile nameless = write_grids(recipes);
    CHECK(load_density_field({nameless.path, "[0]"}).max_value() == 1.0f);
    CHECK(load_density_field({nameless.path, "[2]"}).max_value() == 3.0f);
}

TEST_CASE("negative values of quantised grids count as 0 and are counted", "[gpu][density][hard]") {
    GridRecipe recipe = rough_recipe();
    recipe.storage = GENERATE(Storage::fp4, Storage::fp8, Storage::fp16, Storage::fpn);
    recipe.value = [](glm::ivec3 i) { return static_cast<float>(voxel_noise(i, 9) - 0.3); };
    const TestGrid grid = make_test_grid(recipe);
    std::uint64_t negative = 0;
    for (int z = recipe.first.z; z <= recipe.last.z; ++z)
        for (int y = recipe.first.y; y <= recipe.last.y; ++y)
            for (int x = recipe.first.x; x <= recipe.last.x; ++x)
                negative += grid.accessor({x, y, z}) < 0.0f;
    // Voxels of the same leaves outside the box are 0, and quantised to what is nearest: at most half a quantum below.
    CAPTURE(negative);
    CHECK(grid.field().cleaned >= negative);
    CHECK(negative > 0);
    check_host(grid);
    check_lookups(grid);
}

TEST_CASE("grids of one voxel, and of none", "[gpu][density][hard]") {
    GridRecipe recipe;
    recipe.first = recipe.last = {-9, 7, 0};
    recipe.value = [](glm::ivec3) { return 3.0f; };
    const TestGrid one = make_test_grid(recipe);
    CHECK(one.field().active_voxels == 1);
    check_host(one);
    check_lookups(one, 2000);

    recipe.value = [](glm::ivec3) { return 0.0f; };
    recipe.background = GENERATE(0.0f, 0.5f);
    recipe.value = [&](glm::ivec3) { return recipe.background; };
    const TestGrid none = make_test_grid(recipe);
    CHECK(none.field().active_voxels == 0);
    CHECK(none.field().value({-9, 7, 0}) == 0.0f);
}
