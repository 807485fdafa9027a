// What single precision does to the walk over majorant cells: the bounds that majorant.glsl derives, at every scale,
// and the places far away that the host brings near.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <random>

#include "frame_params.h"
#include "kernels/test_items.h"
#include "support/images.h"
#include "support/numbers.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "support/test_scene.h"
#include "surface_gaps.h"
#include "walk.spv.h"

using namespace vkvol;
using Catch::Contains;
using shared::RayInput;
using shared::WalkStep;
using test_numbers::u;

namespace {

constexpr int most_steps = 96;

// Rays from within the grid, so that the walk's origin is the ray's own, to all sides and along axes. `e`: the optical
// depth to fly. A voxel is `scale` world units long.
std::vector<RayInput> rays_from_within(const TestGrid& grid, double scale) {
    std::mt19937 engine(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<RayInput> rays;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 at(uniform(engine), uniform(engine), uniform(engine));
        glm::dvec3 direction(normal(engine), normal(engine), normal(engine));
        if (i % 10 == 0)
            direction[i / 10 % 3] = 0.0;
        const glm::dvec3 low(grid.voxel_min), high(grid.voxel_max);
        rays.push_back({glm::mix(low, high, at), glm::normalize(direction) / scale, 0,
                        static_cast<float>(-std::log(1.0 - uniform(engine)) * 3.0 + 1e-3), 0.0f, glm::vec3(1.0f)});
    }
    return rays;
}

// Where the ray leaves the cell or the medium, from the very numbers that the device has.
double exact_exit(const RayInput& ray, const TestGrid& grid, glm::ivec3 cell) {
    const MajorantGrid& m = grid.majorants();
    double exit = 1e300;
    for (int axis = 0; axis < 3; ++axis)
        if (ray.direction[axis] != 0.0f) {
            const double face = m.origin[axis] + (cell[axis] + (ray.direction[axis] > 0.0f ? 1 : 0)) * double(m.cell);
            const double end = ray.direction[axis] > 0.0f ? grid.voxel_max[axis] + 1.0 : grid.voxel_min[axis] - 1.0;
            for (const double plane : {face, end})
                exit = std::min(exit, (plane - ray.origin[axis]) / ray.direction[axis]);
        }
    return exit;
}

// Follows one walk with exact distances and optical depths beside the device's; returns the largest errors in units of
// their bounds. For t that is 8 u t: 6 for a face, 7 for the end of the medium, whose inverse direction rounds on its
// own, and second order.
struct Errors {
    double t = 0.0, tau = 0.0, collision = 0.0;
};
Errors errors_of(const TestGrid& grid, const RayInput& ray, const WalkStep* steps, double sigma_t) {
    const MajorantGrid& m = grid.majorants();
    Errors errors;
    double t = 0.0, tau = ray.e, before = 0.0, rounding = 0.0;
    int k = 0;
    for (; k < most_steps; ++k) {
        const WalkStep& step = steps[k];
        const float bound = m.bounds[(std::size_t(step.cell.x) * m.dims.y + step.cell.y) * m.dims.z + step.cell.z];
        const double sigma = static_cast<float>(sigma_t) * double(bound);
        const double exit = std::max(t, exact_exit(ray, grid, step.cell));
        rounding += u * ray.e + 3.0 * u * sigma * (exit - t) + std::abs(sigma - before) * 8.0 * u * t;
        if (step.event == 1u) { // collided
            const double exact = t + tau / sigma;
            const double allowed = rounding / sigma + 8.0 * u * exact + 4.0 * u * (exact - t);
            worsen(errors.collision, std::abs(step.t - exact) / allowed);
            break;
        }
        tau -= sigma * (exit - t);
        before = sigma;
        t = exit;
        rounding += sigma * 8.0 * u * t; // of this end, until the next cell is known to be alike
        worsen(errors.t, std::abs(step.t - t) / (8.0 * u * t + 1e-300));
        worsen(errors.tau, std::abs(step.tau - tau) / rounding);
        rounding -= sigma * 8.0 * u * t;
        if (step.event == 2u) // left
            break;
    }
    CHECK(k < m.dims.x + m.dims.y + m.dims.z);
    return errors;
}

GridRecipe wide_recipe() {
    GridRecipe recipe = rough_recipe();
    recipe.first = {-60, -8, -1};
    recipe.last = {63, 30, 50};
    recipe.cell = 4;
    return recipe;
}

} // namespace

TEST_CASE("walks err by no more than derived, at every scale", "[gpu][precision][hard]") {
    const TestGrid grid = make_test_grid(wide_recipe());
    const double scale = GENERATE(1e-5, 1e-2, 1.0, 1e3, 1e6);
    Volume volume;
    volume.sigma_a = Rgb(0.2 / scale);
    volume.sigma_s = Rgb(0.0);
    volume.unit = CoefficientUnit::world;
    const TestScene scene = make_test_scene(grid.volume, volume);
    KernelRunner runner(walk_spv, scene.specialization, scene.kernel);
    runner.push.step_limit = most_steps;
    const std::vector<RayInput> rays = rays_from_within(grid, scale);
    const auto steps = runner.run<WalkStep>(rays, rays.size() * most_steps);
    Errors worst;
    int collided = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Errors errors = errors_of(grid, rays[i], &steps[i * most_steps], 0.2 / scale);
        worsen(worst.t, errors.t);
        worsen(worst.tau, errors.tau);
        worsen(worst.collision, errors.collision);
        collided += errors.collision > 0.0;
    }
    CAPTURE(scale, worst.t, worst.tau, worst.collision, collided);
    CHECK(worst.t <= 1.0);
    CHECK(worst.tau <= 1.0);
    CHECK(worst.collision <= 1.0);
    CHECK(worst.t > 0.05); // the bounds mean something
    CHECK(collided > 200);
}

// A million radii from a ball. Rays that began at the eye would miss their points by 0.06; the mean over a window that
// the silhouette crosses would be 12 standard errors off at these samples.
TEST_CASE("a camera a million radii away sees its window exactly", "[gpu][precision][hard]") {
    Scene scene = scene_of(medium(Sphere{}, 1.0, 0.5, 0.3), 2.4, 32, 1e6, glm::dvec3(0.0), {-20.0, 30.0, 0.0});
    scene.picture.width = scene.picture.height = 12;
    scene.picture.start_x = 20.0;
    scene.picture.start_y = 10.0;
    scene.background = Rgb(1.0);
    scene.lights = {sunlight()};
    scene.settings.spp = 1024;
    const Film reference = render_reference(scene, 62);
    CHECK_AGREEMENT(agree(render_here(scene, 61).film, reference, "ball from a million radii"));
    Scene beside = scene; // of a plane below all there is, which shines as what it hides
    beside.surfaces.emplace_back().shape = PlaneSurface{{0.0, -1e9, 0.0}, {0.0, 1.0, 0.0}};
    beside.surfaces.back().material.color = Rgb(0.0);
    beside.surfaces.back().emission = scene.background;
    CHECK_AGREEMENT(agree(render_here(beside, 61).film, reference, "with a plane"));
    scene.volumes = {medium(write_grid(cloud_grid()), 1.0, 0.8, 0.3)};
    scene.camera.position *= 10.0; // the cloud is ten wide
    scene.settings.spp = 512;
    CHECK_AGREEMENT(agree(render_here(scene, 63).film, render_reference(scene, 64), "cloud from afar"));
}

// As of tools that give every grid the same transform, wherever it lies. The medium stays where it is, its indices
// move.
TEST_CASE("indices of a million are as good as small ones", "[gpu][precision][hard][long]") {
    GridRecipe far = cloud_grid();
    const glm::ivec3 shift(1000001, -2000003, 3000005);
    far.first += shift;
    far.last += shift;
    far.value = [=](glm::ivec3 i) { return cloud_noise(i - shift); };
    far.translation = glm::dvec3(0.0);
    far.translation = -center_of(far);
    Scene scene = scene_of(medium(write_grid(far), 1.0, 0.9, 0.4), 10.0, 20, 25.0, glm::dvec3(0.0), {15.0, -35.0, 5.0});
    scene.background = {0.3, 0.5, 0.9};
    scene.lights = {sunlight()};
    scene.settings.spp = 256;
    for (const Filter filter : {Filter::nearest, Filter::trilinear}) {
        scene.settings.filter = filter;
        CHECK_AGREEMENT(agree(render_here(scene, 65).film, render_reference(scene, 66),
                              fmt::format("far indices {}", int(filter))));
    }
}

// Transmittances are exact here, so that a fraction of a voxel shows. With the nearer origin coordinates are below 64
// voxels, where 4 ulp are 2^-16: a density between values in [0, 1] errs by three times that, an optical depth by 55
// voxels of extinction 0.3 times as much.
TEST_CASE("a grid far from its index origin is where it was, to a thousandth", "[gpu][precision][hard]") {
    const auto picture = [](glm::ivec3 shift) {
        GridRecipe grid = cloud_grid();
        grid.first += shift;
        grid.last += shift;
        grid.value = [=](glm::ivec3 i) { return cloud_noise(i - shift); };
        grid.translation = glm::dvec3(0.0);
        grid.translation = -center_of(grid);
        Scene scene = scene_of(medium(write_grid(grid), 1.0, 0.0), 10.0, 20, 25.0, glm::dvec3(0.0), {15.0, -35.0, 5.0});
        scene.background = Rgb(1.0);
        scene.settings.integrator = "regularTracking";
        scene.settings.choices.scattering = SCATTERING_NONE;
        scene.settings.spp = 16;
        return render_here(scene, 67).film;
    };
    const Film near = picture(glm::ivec3(0)), far = picture(glm::ivec3(1000001, -2000003, 3000005));
    float worst = 0.0f;
    for (std::size_t i = 0; i < near.pixel_count(); ++i)
        worsen(worst, std::abs(far.mean[i].x - near.mean[i].x));
    CHECK(worst < 55 * 0.3 * 3 * 0x1p-16);
}

// Nothing scatters, so that paths do not part for good where one rounding falls otherwise. The host's doubles know 1e6
// to 1e-10, 4e-10 of a voxel; that moves some floats by an ulp, which in 25600 paths of some ten cells of one in 10^7
// each makes one more step or one fewer at most a few times.
TEST_CASE("far from the origin walks take the same steps", "[gpu][precision][hard]") {
    const auto counts = [](glm::dvec3 shift) {
        GridRecipe grid = cloud_grid();
        grid.translation += shift;
        Scene scene = scene_of(medium(write_grid(grid), 1.5, 0.0), 10.0, 20, 25.0, shift, {15.0, -35.0, 5.0});
        scene.background = Rgb(1.0);
        scene.settings.spp = 64;
        return render_here(scene, 67).counts;
    };
    const RenderCounts near = counts(glm::dvec3(0.0));
    for (const double offset : {1e4, 1e5, 1e6}) {
        const RenderCounts far = counts(glm::dvec3(offset, -offset, offset));
        CAPTURE(offset, far.cells, near.cells, far.lookups, near.lookups);
        CHECK(std::abs(double(far.cells) - double(near.cells)) <= 16.0);
        CHECK(std::abs(double(far.lookups) - double(near.lookups)) <= 16.0);
        CHECK(std::abs(double(far.real_collisions) - double(near.real_collisions)) <= 8.0);
    }
}

// A rectangle below a ball of radius 1 and extinction 3, and something small far off, so that the origin is half way.
TEST_CASE("surfaces off which rays are kept too far are told of", "[cpu][precision]") {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 3.0, 0.9), 10.0, 8);
    scene.surfaces.emplace_back().shape = RectangleSurface{{0.0, -1.0, 0.0}, {4.0, 0.0, 0.0}, {0.0, 0.0, -4.0}};
    scene.surfaces.back().place = "a.xml:1:2";
    scene.volumes.push_back(scene.volumes.front());
    const auto said = [&](double far) {
        std::get<Sphere>(scene.volumes.back().shape).center = {far, 0.0, 0.0};
        const Assets assets = load_assets(scene, choose_method(scene));
        return surface_gap_warning(scene, assets, render_origin(scene, assets.media, &*assets.superposition));
    };
    CHECK(said(10.0).empty());
    CHECK(said(1600.0).empty()); // a gap of 64 u (800 + 4), times 3: 0.0092
    CHECK_THAT(said(1800.0),
               Contains("a.xml:1:2: rays that leave this surface begin 0.0034 world units off it, 0.01 mean "
                        "free paths"));
    CHECK_THAT(said(1e5), Contains("begin 0.19 world units off it, 0.57 mean free paths"));
    scene.surfaces.back().shape = PlaneSurface{{0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}};
    CHECK_THAT(said(1e5), Contains("0.57 mean free paths"));
    scene.surfaces.back().shape = PlaneSurface{{0.0, -1.1, 0.0}, {0.0, 1.0, 0.0}}; // beside the medium
    CHECK(said(1e5).empty());
    scene.surfaces.back().shape = BallSurface{{0.0, -3.0, 0.0}, 1.0}; // 0.19 of 3.46, its box's diagonal
    CHECK_THAT(said(1e5), Contains("5.5 % of its size"));
    scene.surfaces.back().shape = BallSurface{{0.0, -33.0, 0.0}, 30.0};
    CHECK(said(1e5).empty());
    // Panes whose other side rays would begin beyond: 0.0038 of 0.004.
    scene.surfaces.back().material.kind = MaterialKind::dielectric;
    scene.surfaces.back().shape = BallSurface{{0.0, -33.0, 0.0}, 30.0};
    CHECK(said(1e5).empty());
    const TriangleSurface pane{{{-1.0, -9.0, -1.0}, {1.0, -9.0, -1.0}, {0.0, -9.004, 1.0}}, {{0, 1, 2}}};
    scene.surfaces.back().shape = pane;
    CHECK(said(10.0).empty());
    CHECK_THAT(said(2000.0), Contains("begin 0.0038 world units off it, 0.95 times its glass' thickness"));
    scene.surfaces.back().material = {};
    // Of a large mesh those triangles count that are in the medium.
    TriangleSurface mesh{{{-2.0, -1.0, 2.0}, {2.0, -1.0, 2.0}, {0.0, -1.0, -2.0}}, {{0, 1, 2}}};
    scene.surfaces.back().shape = mesh;
    CHECK(said(10.0).empty());
    for (const double out : {0.0, 1e5}) {
        mesh.vertices.insert(mesh.vertices.end(), {{out, -9.0, -2.0}, {1e5, -9.0, 2.0}, {1e5, -9.0, 1e5}});
        mesh.triangles.emplace_back(mesh.vertices.size() - 3, mesh.vertices.size() - 2, mesh.vertices.size() - 1);
    }
    scene.surfaces.back().shape = mesh;
    CHECK(said(10.0).empty());
    mesh.vertices[3].y = 9.0;
    scene.surfaces.back().shape = mesh;
    CHECK_THAT(said(10.0), Contains("begin 0.38 world units off it, 1.1 mean free paths"));
}
