// Majorants bound the density and no more than need be; the device's walk over them misses nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "empty_space.h"
#include "kernels/test_items.h"
#include "pilot_paths.h"
#include "support/test_grids.h"
#include "support/test_scene.h"
#include "walk.spv.h"

using namespace vkvol;
using shared::RayInput;
using shared::WalkStep;

namespace {

float bound_of(const MajorantGrid& m, glm::ivec3 cell) {
    return m.bounds[(std::size_t(cell.x) * m.dims.y + cell.y) * m.dims.z + cell.z];
}

int chessboard(glm::ivec3 a, glm::ivec3 b) {
    const glm::ivec3 apart = glm::abs(a - b);
    return std::max({apart.x, apart.y, apart.z});
}

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

GridRecipe larger_recipe(Storage storage) {
    GridRecipe recipe = rough_recipe();
    recipe.storage = storage;
    recipe.first = {-21, -8, -1};
    recipe.last = {23, 30, 20};
    return recipe;
}

// A walk gives out more majorant optical depth than any grid here holds, so that nothing collides.
constexpr double walk_tau = 1.0e4;
constexpr int walk_steps = 128;

std::vector<std::vector<WalkStep>> walk(const TestGrid& grid, const std::vector<RayInput>& rays) {
    const TestScene scene = make_test_scene(grid.volume, {});
    KernelRunner runner(walk_spv, scene.specialization, scene.kernel);
    runner.push.step_limit = walk_steps;
    const auto flat = runner.run<WalkStep>(rays, rays.size() * walk_steps);
    std::vector<std::vector<WalkStep>> walks(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (int k = 0; k < walk_steps && flat[i * walk_steps + k].event != NO_PIXEL; ++k)
            walks[i].push_back(flat[i * walk_steps + k]);
    return walks;
}

// Distances on the device carry the rounding of the ray's origin, face and difference, a few ulp of coordinates, seen
// along the direction's component; the walk's steps do not add to it.
double distance_tolerance(const RayInput& ray, const MajorantGrid& m) {
    double least = 1.0, largest = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] != 0.0f)
            least = std::min(least, double(std::abs(ray.direction[axis])));
        largest = std::max({largest, double(std::abs(ray.origin[axis])), double(std::abs(m.origin[axis])),
                            double(m.origin[axis] + m.dims[axis] * m.cell)});
    }
    return 16 * 0x1p-24 * largest / least;
}

struct Bounds {
    glm::dvec3 low, high;
};
Bounds bounds_of(const TestGrid& grid) {
    return {glm::dvec3(grid.voxel_min) - 1.0, glm::dvec3(grid.voxel_max) + 1.0};
}

reference::Interval inside_box(const TestGrid& grid, const RayInput& ray) {
    const Bounds box = bounds_of(grid);
    const reference::Interval line =
        reference::intersect(box.low, box.high, {glm::dvec3(ray.origin), glm::dvec3(ray.direction)});
    return reference::clip(line, {0.0, std::numeric_limits<double>::infinity()});
}

// What must hold for any ray: the steps join from entry to exit, each lies in its cell or, if that is empty and the
// walk leaps, within its reach, and each cell's majorant is that of the grid. A ray in a face may count as in either
// neighbour.
void check_walk(const TestGrid& grid, const RayInput& ray, const std::vector<WalkStep>& steps) {
    const MajorantGrid& m = grid.majorants();
    INFO("origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z << " direction " << ray.direction.x
                   << ' ' << ray.direction.y << ' ' << ray.direction.z);
    const reference::Interval inside = inside_box(grid, ray);
    const double eps = distance_tolerance(ray, m);
    const std::vector<float> walked = walked_cells(m);
    if (steps.empty()) {
        CHECK(inside.length() <= eps);
        return;
    }
    REQUIRE(steps.size() < walk_steps);
    REQUIRE(steps.size() <= static_cast<std::size_t>(m.dims.x + m.dims.y + m.dims.z));
    REQUIRE(steps.back().event == 2u); // left
    double t = inside.t0, tau = 0.0;
    for (const WalkStep& step : steps) {
        REQUIRE(step.cell == glm::clamp(step.cell, glm::ivec3(0), m.dims - 1));
        const float expected = walked[(std::size_t(step.cell.x) * m.dims.y + step.cell.y) * m.dims.z + step.cell.z];
        REQUIRE(step.sigma_maj == expected); // sigma_t is 1
        const int reach = std::max(-int(expected), 0);
        REQUIRE(step.t >= t - eps);
        // The middle of the step lies within the closed cell.
        const glm::dvec3 middle = glm::dvec3(ray.origin) + 0.5 * (t + step.t) * glm::dvec3(ray.direction);
        const glm::dvec3 low = glm::dvec3(m.origin + step.cell * m.cell);
        double exit = inside.t1;
        for (int axis = 0; axis < 3; ++axis) {
            REQUIRE(middle[axis] >= low[axis] - reach * m.cell - eps);
            REQUIRE(middle[axis] <= low[axis] + (reach + 1) * m.cell + eps);
            if (ray.direction[axis] != 0.0f) {
                const double face = low[axis] + (ray.direction[axis] > 0.0f ? reach + 1 : -reach) * m.cell;
                exit = std::min(exit, (face - double(ray.origin[axis])) / double(ray.direction[axis]));
            }
        }
        REQUIRE(std::abs(step.t - std::max(exit, t)) <= 2.0 * eps); // as far as it can go
        tau += std::max(step.sigma_maj, 0.0f) * (step.t - t);
        t = step.t;
    }
    CHECK(std::abs(t - inside.t1) <= eps);
    // What the walk has spent is the sum of majorant * length; each of its subtractions from walk_tau rounds to half
    // an ulp of that, and its lengths differ from those here by eps.
    const double spent = walk_tau - steps.back().tau;
    const double rounding = steps.size() * (0x1p-24 * 2.0 * walk_tau + 2.0 * eps * grid.highest);
    CHECK(std::abs(spent - tau) <= rounding);
}

// Majorant optical depth by cutting the ray at every cell plane and looking at the middle of each piece.
double brute_force_tau(const TestGrid& grid, const RayInput& ray) {
    const MajorantGrid& m = grid.majorants();
    const glm::dvec3 o(ray.origin), d(ray.direction);
    const reference::Interval inside = inside_box(grid, ray);
    if (inside.empty())
        return 0.0;
    std::vector<double> cuts = {inside.t0, inside.t1};
    for (int axis = 0; axis < 3; ++axis)
        for (int plane = 0; plane <= m.dims[axis] && d[axis] != 0.0; ++plane)
            cuts.push_back(std::clamp((m.origin[axis] + plane * m.cell - o[axis]) / d[axis], inside.t0, inside.t1));
    std::sort(cuts.begin(), cuts.end());
    double tau = 0.0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const glm::dvec3 p = o + 0.5 * (cuts[i] + cuts[i + 1]) * d - glm::dvec3(m.origin);
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(p / double(m.cell))), glm::ivec3(0), m.dims - 1);
        tau += bound_of(m, cell) * (cuts[i + 1] - cuts[i]);
    }
    return tau;
}

double device_tau(const std::vector<WalkStep>& steps, double start) {
    double tau = 0.0, t = start;
    for (const WalkStep& step : steps) {
        tau += std::max(step.sigma_maj, 0.0f) * (step.t - t);
        t = step.t;
    }
    return tau;
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
    const Bounds box = bounds_of(grid);
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> uniform;
    int violations = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const glm::dvec3 u(uniform(engine), uniform(engine), uniform(engine));
        const glm::dvec3 p = box.low + u * (box.high - box.low);
        const glm::ivec3 at(glm::floor((p - glm::dvec3(m.origin)) / double(cell)));
        violations += !(exact.trilinear(p) <= bound_of(m, at) * (1.0 + 1e-14));
    }
    CHECK(violations == 0);
}

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

TEST_CASE("between two looks there are as many steps as lanes seldom wait for", "[cpu][majorant]") {
    CHECK(best_steps_per_look({}) == 4);
    CHECK(best_steps_per_look({1.0, 1.2, 1.9}) == 2);
    CHECK(best_steps_per_look({2.5, 3.0, 3.0}) == 3);
    CHECK(best_steps_per_look({40.0, 2.0, 25.0}) == 4);
}

TEST_CASE("the reach of an empty cell is how far all cells around it are empty", "[cpu][majorant]") {
    std::mt19937 engine(5);
    MajorantGrid m{8, {0, 0, 0}, {17, 13, 11}, {}};
    const int every = GENERATE(3, 50, 1000); // cells, one of which is not empty
    for (int i = 0; i < m.dims.x * m.dims.y * m.dims.z; ++i)
        m.bounds.push_back(engine() % every == 0 ? 0.5f : 0.0f);
    const std::vector<std::uint8_t> reaches = empty_reaches(m);
    m.leaps = true;
    const std::vector<float> walked = walked_cells(m);
    std::size_t i = 0;
    for (glm::ivec3 a(0); a.x < m.dims.x; ++a.x)
        for (a.y = 0; a.y < m.dims.y; ++a.y)
            for (a.z = 0; a.z < m.dims.z; ++a.z, ++i) {
                int nearest = 255; // beyond the grid all is empty
                for (glm::ivec3 b(0); b.x < m.dims.x; ++b.x)
                    for (b.y = 0; b.y < m.dims.y; ++b.y)
                        for (b.z = 0; b.z < m.dims.z; ++b.z)
                            if (bound_of(m, b) > 0.0f)
                                nearest = std::min(nearest, chessboard(a, b));
                REQUIRE(int(reaches[i]) == std::max(nearest - 1, 0));
                REQUIRE(walked[i] == (nearest == 0 ? 0.5f : -float(std::max(nearest - 1, 0))));
            }
    m.leaps = false;
    CHECK(walked_cells(m) == m.bounds);
}

TEST_CASE("reaches end at what a byte holds", "[cpu][majorant]") {
    MajorantGrid row{8, {0, 0, 0}, {1, 600, 1}, std::vector<float>(600, 0.0f)};
    row.bounds[0] = 1.0f;
    const std::vector<std::uint8_t> reaches = empty_reaches(row);
    for (int i = 0; i < 600; ++i)
        REQUIRE(int(reaches[std::size_t(i)]) == std::clamp(i - 1, 0, 254));
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

TEST_CASE("majorant grids have no more than 2^24 cells", "[cpu][majorant]") {
    DensityField vast;
    vast.active_voxels = 2;
    vast.voxel_max = {2100, 2100, 2100}; // 263^3 cells of 8 voxels are more than 2^24
    CHECK(make_majorant_grid(vast, 4).cell == 16);
}

TEST_CASE("the device walks the cells that a ray passes", "[gpu][majorant]") {
    GridRecipe recipe = GENERATE(false, true) ? sparse_recipe() : larger_recipe(Storage::float32);
    recipe.cell = GENERATE(4, 8, 16, 5);
    CAPTURE(recipe.cell);
    TestGrid grid = make_test_grid(recipe);
    grid.volume.majorants->leaps = GENERATE(false, true);
    const Bounds box = bounds_of(grid);
    std::mt19937 engine(13);
    std::uniform_real_distribution<double> uniform;
    const auto random = [&] { return glm::dvec3(uniform(engine), uniform(engine), uniform(engine)); };
    std::vector<RayInput> rays;
    while (rays.size() < 4000) { // from within and from outside, towards a point within
        const double reach = rays.size() % 2 == 0 ? 1.0 : 3.0;
        const glm::dvec3 middle = 0.5 * (box.low + box.high), extent = box.high - box.low;
        const glm::dvec3 origin = middle + reach * (random() - 0.5) * extent;
        const glm::dvec3 target = middle + 0.9 * (random() - 0.5) * extent;
        rays.push_back({origin, glm::normalize(target - origin), 0, 0.0f, 0.0f, glm::vec3(1.0f)});
    }
    const auto walks = walk(grid, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        check_walk(grid, rays[i], walks[i]);
        // A step may end eps early or late at each face, in a cell of another majorant.
        const double tolerance = walks[i].size() * 2.0 * distance_tolerance(rays[i], grid.majorants()) * grid.highest;
        REQUIRE(std::abs(device_tau(walks[i], inside_box(grid, rays[i]).t0) - brute_force_tau(grid, rays[i])) <=
                tolerance);
    }
}

TEST_CASE("axis-parallel rays, on faces, edges and borders, pass every cell once", "[gpu][majorant][hard]") {
    GridRecipe recipe = GENERATE(false, true) ? sparse_recipe() : larger_recipe(Storage::float32);
    recipe.cell = GENERATE(4, 8, 16, 5);
    const bool mirror_zero = GENERATE(false, true); // direction components -0.0
    CAPTURE(recipe.cell, mirror_zero);
    TestGrid grid = make_test_grid(recipe);
    grid.volume.majorants->leaps = GENERATE(false, true);
    const MajorantGrid& m = grid.majorants();
    const Bounds box = bounds_of(grid);
    // Places across the ray: least face, a face between cells, inside, a voxel plane, greatest face.
    const auto places = [&](int axis) {
        return std::vector<double>{box.low[axis],        box.low[axis] + m.cell, box.low[axis] + 2.0 * m.cell,
                                   box.low[axis] + 1.25, box.low[axis] + 1.0,    box.high[axis]};
    };
    const float zero = mirror_zero ? -0.0f : 0.0f;
    std::vector<RayInput> rays;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f})
            for (const double a : places((axis + 1) % 3))
                for (const double b : places((axis + 2) % 3))
                    // From outside, on the border, on a face within, and on the far border, heading out.
                    for (const double start : {box.low[axis] - 7.0, box.low[axis], box.low[axis] + m.cell,
                                               box.low[axis] + 3.5, box.high[axis], box.high[axis] + 2.0}) {
                        glm::vec3 origin, direction(zero);
                        origin[axis] = static_cast<float>(start);
                        origin[(axis + 1) % 3] = static_cast<float>(a);
                        origin[(axis + 2) % 3] = static_cast<float>(b);
                        direction[axis] = sign;
                        rays.push_back({origin, direction, 0, 0.0f, 0.0f, glm::vec3(1.0f)});
                    }
    const auto walks = walk(grid, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        check_walk(grid, rays[i], walks[i]);
        // Row 19: as the same ray a little inside the cells that its own floor() names, except at the far border.
        RayInput moved = rays[i];
        for (int axis = 0; axis < 3; ++axis)
            if (moved.direction[axis] == 0.0f)
                moved.origin[axis] += moved.origin[axis] >= float(box.high[axis]) ? -1e-4f : 1e-4f;
        const double expected = brute_force_tau(grid, moved);
        const double actual = device_tau(walks[i], inside_box(grid, rays[i]).t0);
        CHECK(actual == Approx(expected).epsilon(1e-6).margin(1e-6));
    }
}

TEST_CASE("rays through edges and corners of cells lose nothing", "[gpu][majorant][hard]") {
    TestGrid grid = make_test_grid(GENERATE(false, true) ? sparse_recipe() : larger_recipe(Storage::float32));
    grid.volume.majorants->leaps = GENERATE(false, true);
    const MajorantGrid& m = grid.majorants();
    std::vector<RayInput> rays;
    for (int i = 0; i < 26; ++i) { // diagonals of faces and of the cube, from and through corners of cells
        const glm::ivec3 d = glm::ivec3(i < 13 ? i : i + 1) / glm::ivec3(1, 3, 9) % 3 - 1;
        for (int k = 0; k < 27; ++k) {
            const glm::ivec3 corner = glm::ivec3(k) / glm::ivec3(1, 3, 9) % 3;
            const glm::dvec3 through(m.origin + corner * m.cell);
            for (const double back : {0.0, 8.0, 100.0})
                rays.push_back(
                    {through - back * glm::dvec3(d), glm::normalize(glm::dvec3(d)), 0, 0.0f, 0.0f, glm::vec3(1.0f)});
        }
    }
    const auto walks = walk(grid, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        check_walk(grid, rays[i], walks[i]);
        // As a ray beside it, which meets each cell's corner within so much of it.
        constexpr double aside = 1e-4;
        RayInput moved = rays[i];
        moved.origin += glm::vec3(aside, 0.7 * aside, 0.4 * aside);
        const double actual = device_tau(walks[i], inside_box(grid, rays[i]).t0);
        CHECK(std::abs(actual - brute_force_tau(grid, moved)) <= 4.0 * aside * (walks[i].size() + 2.0) * grid.highest);
    }
}
