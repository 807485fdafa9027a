// Scenes that are the same picture in different words.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

Scene lit(const Volume& volume, double width, double distance, glm::dvec3 target = glm::dvec3(0.0)) {
    Scene scene = scene_of(volume, width, 20, distance, target, {15.0, -35.0, 5.0});
    scene.background = {0.3, 0.5, 0.9};
    scene.lights = {sunlight()};
    scene.settings.spp = 64;
    return scene;
}

// The cloud, everything `scale` times as large and seen as before.
Scene scaled_cloud(double scale, glm::dvec3 shift = glm::dvec3(0.0)) {
    GridRecipe grid = cloud_grid();
    grid.linear *= scale;
    grid.translation = grid.translation * scale + shift;
    return lit(medium(write_grid(grid), 1.5 / scale, 0.9, 0.4), 10.0 * scale, 25.0 * scale, shift);
}

Scene scaled_ball(double scale) {
    return lit(medium(Sphere{glm::dvec3(0.2, 0.1, -0.3) * scale, scale}, 3.0 / scale, 0.9, 0.4), 2.6 * scale,
               5.0 * scale);
}

} // namespace

TEST_CASE("a medium of density zero is no medium, bit for bit", "[gpu][hard][invariance][long]") {
    Scene nothing = lit(medium(Sphere{}, 0.0, 0.0), 2.0, 5.0);
    nothing.volumes.clear();
    const Film empty = render_here(nothing, 20).film;
    GridRecipe zeros{{-3, -4, -5}, {6, 7, 8}, [](glm::ivec3) { return 0.0f; }};
    const GridFile inactive = write_grid(zeros);
    zeros.background = 1.0f;
    const GridFile active = write_grid(zeros);
    for (const Volume& volume : {medium(Sphere{}, 0.0, 0.0), medium(Box{}, 0.0, 0.0), medium(inactive, 2.0, 0.5),
                                 medium(active, 2.0, 0.5), medium(active, 0.0, 0.5)}) {
        Scene scene = nothing;
        scene.volumes = {volume};
        CHECK(same_bits(render_here(scene, 20).film, empty));
        scene.volumes.front().sigma_s = Rgb(1.0);
        scene.volumes.front().density_scale = 0.0;
        CHECK(same_bits(render_here(scene, 20).film, empty));
    }
}

// Nearest lookup makes it a box that ends half a voxel beyond the outermost voxel centres.
TEST_CASE("a constant grid is a homogeneous box", "[gpu][hard][invariance][long]") {
    GridRecipe grid{{2, -4, 5}, {11, 3, 10}, [](glm::ivec3) { return 2.0f; }};
    grid.linear = glm::dmat3(0.2);
    grid.translation = -center_of(grid);
    Scene voxels = lit(medium(write_grid(grid), 1.5, 0.9, 0.4), 2.6, 6.0);
    voxels.settings.filter = Filter::nearest;
    voxels.settings.spp = 256;
    Scene box = voxels;
    box.volumes = {medium(Box{glm::dvec3(0.0), glm::dvec3(10, 8, 6) * 0.2}, 3.0, 0.9, 0.4)};
    for (const char* integrator : {"deltaTracking", "ratioTracking"}) {
        voxels.settings.integrator = box.settings.integrator = integrator;
        CHECK_AGREEMENT(agree(render_here(voxels, 21).film, render_here(box, 22).film,
                              fmt::format("constant grid and box, {}", integrator)));
    }
}

TEST_CASE("a scene a power of two larger has the same bits", "[gpu][hard][invariance]") {
    const Film ball = render_here(scaled_ball(1.0), 23).film;
    const Film cloud = render_here(scaled_cloud(1.0), 23).film;
    for (const int exponent : {-16, -3, 1, 20}) {
        CAPTURE(exponent);
        CHECK(same_bits(render_here(scaled_ball(std::ldexp(1.0, exponent)), 23).film, ball));
        CHECK(same_bits(render_here(scaled_cloud(std::ldexp(1.0, exponent)), 23).film, cloud));
    }
}

TEST_CASE("the unit of length does not matter", "[gpu][hard][invariance]") {
    const double scale = GENERATE(1e-5, 1e-3, 1e3, 1e6);
    CHECK_AGREEMENT(agree(render_here(scaled_ball(scale), 24).film, render_here(scaled_ball(1.0), 25).film,
                          fmt::format("sphere at scale {}", scale)));
    CHECK_AGREEMENT(agree(render_here(scaled_cloud(scale), 24).film, render_here(scaled_cloud(1.0), 25).film,
                          fmt::format("cloud at scale {}", scale)));
}

// Render space has its origin amid the medium. What is left is the rounding of doubles, 1e6 * 2^-53, which may put a
// float one unit in the last place off: few paths differ, so with the same seed the pictures differ by less than noise.
TEST_CASE("a scene far from the origin looks the same", "[gpu][hard][invariance]") {
    const glm::dvec3 shift =
        GENERATE(glm::dvec3(1e4, -1e4, 1e4), glm::dvec3(1e5, 1e5, -1e5), glm::dvec3(-1e6, 1e6, 1e6));
    const RenderResult far = render_here(scaled_cloud(1.0, shift), 26), near = render_here(scaled_cloud(1.0), 26);
    CHECK(double(far.counts.lookups) == Approx(double(near.counts.lookups)).epsilon(0.01));
    const double difference = mean_of(far.film) / mean_of(near.film) - 1.0;
    std::ptrdiff_t moved = 0;
    for (std::size_t i = 0; i < far.film.pixel_count(); ++i)
        moved += far.film.mean[i] != near.film.mean[i];
    CAPTURE(shift.x, moved, difference);
    CHECK(std::abs(difference) < 1e-3);
    CHECK_AGREEMENT(agree(far.film, render_here(scaled_cloud(1.0), 29).film, fmt::format("cloud at {}", shift.x)));
}

TEST_CASE("grids may be rotated, sheared, stretched and mirrored", "[gpu][hard][invariance]") {
    const auto [name, linear] = GENERATE(table<std::string, glm::dmat3>({
        {"rotated", glm::dmat3({0.18, 0.24, 0.0}, {-0.24, 0.18, 0.0}, {0.0, 0.0, 0.3})},
        {"sheared and mirrored", skewed * 0.6},
        {"mirrored", glm::dmat3({-0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3})},
        {"stretched", glm::dmat3({0.1, 0, 0}, {0, 0.5, 0}, {0, 0, 0.3})},
    }));
    const CoefficientUnit unit = GENERATE(CoefficientUnit::world, CoefficientUnit::voxel);
    GridRecipe grid = cloud_grid();
    grid.linear = linear;
    grid.translation = glm::dvec3(0.0);
    grid.translation = -center_of(grid);
    Scene scene = lit(medium(write_grid(grid), 1.0, 0.9, 0.4), 10.0, 30.0);
    scene.volumes.front().unit = unit;
    scene.settings.filter = Filter::trilinear;
    scene.settings.spp = 128;
    CHECK_AGREEMENT(agree(render_here(scene, 27).film, render_reference(scene, 28), name + " grid"));
}

TEST_CASE("models are moved, turned, stretched and mirrored by their transform", "[gpu][invariance]") {
    // A large body and a small one beside it, so that no turn leaves them as they are.
    const Mesh bodies =
        join(make_box({-1.0, -0.5, -0.7}, {0.3, 0.8, 0.6}, 1), make_box({0.6, 0.1, -0.2}, {1.1, 0.7, 0.9}, 1));
    const glm::dmat4 turn =
        glm::rotate(glm::translate(glm::dmat4(1.0), {0.2, -0.1, 0.3}), 0.8, glm::normalize(glm::dvec3(1.0, 2.0, -1.0)));
    const glm::dvec3 scales = GENERATE(glm::dvec3(1.0), glm::dvec3(0.7, 1.3, 0.9), glm::dvec3(-1.0, 1.0, 1.0));
    const glm::dmat4 transform = glm::scale(turn, scales);
    Volume moved = medium(write_mesh(bodies), 1.5, 0.9, 0.4);
    moved.transform = transform;
    Mesh by_hand = bodies;
    for (auto& vertex : by_hand.vertices)
        vertex = glm::dvec3(transform * glm::dvec4(vertex, 1.0));
    CAPTURE(scales.x, scales.y, scales.z);
    CHECK_AGREEMENT(agree(render_here(lit(moved, 4.0, 12.0), 1).film,
                          render_here(lit(medium(write_mesh(by_hand), 1.5, 0.9, 0.4), 4.0, 12.0), 2).film,
                          "models by a transform"));
}

// Its author may name any point of a plane. A texture begins at it, and these tiles are 2 wide.
TEST_CASE("a plane is where it is by each of its points", "[gpu][hard][invariance][surfaces]") {
    const glm::vec3 red(0.9f, 0.4f, 0.1f), grey(0.2f);
    const auto image = std::make_shared<const Texture>(Texture{2, 2, {red, grey, grey, red}, true});
    const glm::dvec3 there(1e6, 0.0, -5e5);
    for (const double tilt : {0.0, 0.25}) {
        CAPTURE(tilt);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.0, 1.0, tilt)), along(0.0, -tilt, 1.0);
        const auto picture = [&](const glm::dvec3& point, std::uint32_t seed) {
            Scene scene = scene_of({}, 8.0, 20, 25.0, there, {10.0, -40.0, 0.0});
            scene.volumes.clear();
            scene.lights = {sunlight()};
            scene.settings.spp = 64;
            scene.surfaces.emplace_back().shape = BallSurface{there + normal, 1.0};
            Surface& ground = scene.surfaces.emplace_back();
            ground.shape = PlaneSurface{point, normal};
            ground.axes = glm::dmat3(glm::dvec3(1.0, 0.0, 0.0), glm::normalize(along), normal);
            ground.material.image = image;
            ground.material.repeat = glm::dvec2(0.5);
            return render_here(scene, seed).film;
        };
        const Film near = picture(there, 30);
        CHECK_AGREEMENT(agree(picture(there - glm::dvec3(1e6, 0.0, 0.0), 31), near, "far along x"));
        CHECK_AGREEMENT(agree(picture(there + 1e5 * glm::normalize(along), 32), near, "far along z"));
    }
}
