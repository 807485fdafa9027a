// The device's walk over majorant cells misses nothing, whether or not it leaps over empty ones.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "empty_space.h"
#include "kernels/test_items.h"
#include "support/numbers.h"
#include "support/test_grids.h"
#include "support/test_scene.h"
#include "walk.spv.h"

using namespace vkvol;
using shared::RayInput;
using shared::WalkStep;
using test_numbers::left;

namespace {

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
    REQUIRE(steps.back().event == left);
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

TEST_CASE("the device walks the cells that a ray passes", "[gpu][majorant]") {
    GridRecipe recipe = GENERATE(false, true) ? sparse_recipe() : larger_recipe(Storage::float32);
    recipe.cell = GENERATE(4, 8, 16, 5);
    CAPTURE(recipe.cell);
    TestGrid grid = make_test_grid(recipe);
    const bool leaps = GENERATE(false, true);
    grid.change_majorants([&](MajorantGrid& majorants) { majorants.leaps = leaps; });
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
    const bool leaps = GENERATE(false, true);
    grid.change_majorants([&](MajorantGrid& majorants) { majorants.leaps = leaps; });
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
    const bool leaps = GENERATE(false, true);
    grid.change_majorants([&](MajorantGrid& majorants) { majorants.leaps = leaps; });
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
