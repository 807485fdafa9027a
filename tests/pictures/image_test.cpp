// Whole pictures: the renderer against the scalar reference, and its estimators against each other, per pixel and in
// the mean.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

constexpr Rgb blue_sky{0.3, 0.5, 0.9};

Scene picture_of(const Volume& volume, double width, std::uint32_t samples) {
    Scene scene = scene_of(volume, width, 24, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = blue_sky;
    scene.lights = {sunlight({3.0, 2.5, 1.5})};
    scene.settings.spp = samples;
    scene.settings.filter = Filter::trilinear;
    return scene;
}

Scene ball(double g) {
    return picture_of(medium(Sphere{{0.1, -0.1, 0.0}, 1.0}, 4.0, 0.95, g), 2.6, 256);
}

// Thin: optical depth about 1 across the middle. Thick: about 10.
Scene cloud(double sigma_t, double albedo, double g = 0.3, std::uint32_t samples = 192) {
    return picture_of(medium(cloud_file(), sigma_t, albedo, g), 11.0, samples);
}
constexpr double thin = 0.4, thick = 4.0;

void check(Scene scene, const std::string& name, const std::vector<const char*>& integrators) {
    for (const char* integrator : integrators) {
        scene.settings.integrator = integrator;
        CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), name + ", " + integrator));
    }
}

void check_both(const Scene& scene, const std::string& name) {
    check(scene, name, {"deltaTracking", "ratioTracking"});
}

} // namespace

TEST_CASE("homogeneous media equal the reference", "[gpu][image]") {
    for (const double g : {0.8, -0.8, 0.0})
        check_both(ball(g), fmt::format("sphere, g {}", g));
    check_both(picture_of(medium(Box{{0.1, 0.2, 0.0}, {1.0, 2.0, 1.5}}, 3.0, 0.9, 0.5), 3.0, 256), "box");
}

TEST_CASE("a thin cloud equals the reference", "[gpu][image][long]") {
    check_both(cloud(thin, 0.95), "thin cloud");
    check(cloud(thin, 1.0), "thin white cloud", {"ratioTracking"});
}

TEST_CASE("a thick cloud equals the reference", "[gpu][image][long]") {
    check_both(cloud(thick, 0.95), "thick cloud");
    check(cloud(thick, 1.0, 0.8, 96), "thick white cloud", {"ratioTracking"});
}

// A rough slab of 4 optical depths: nearly half of the light that is scattered once comes through T < 0.1, where shadow
// rays play roulette. With the sun on the camera's side that light is lost among the rest.
TEST_CASE("a slab lit from behind equals the reference", "[gpu][image]") {
    GridRecipe grid{{-20, -20, -6}, {19, 19, 5}, [](glm::ivec3 i) { return float(0.5 + 0.5 * voxel_noise(i, 3)); }};
    grid.linear = glm::dmat3(0.25);
    grid.translation = -center_of(grid);
    Scene scene = scene_of(medium(write_grid(grid), 4.0 / (12 * 0.75 * 0.25), 0.9, 0.3), 3.0, 24, 25.0);
    scene.settings.spp = 384;
    scene.settings.max_depth = 1;
    scene.lights = {DirectionalLight{{0.0, 0.0, -1.0}, Rgb(3.0)}};
    check(scene, "slab lit from behind", {"ratioTracking"});
}

TEST_CASE("roulette changes no mean", "[gpu][image]") {
    for (const double threshold : {0.0, 0.9}) {
        Scene scene = cloud(thick, 0.6);
        scene.settings.roulette_threshold = threshold;
        check_both(scene, fmt::format("cloud with roulette below {}", threshold));
    }
}

TEST_CASE("an emitting cloud equals the reference", "[gpu][image][long]") {
    Scene scene = cloud(thick, 0.5);
    scene.volumes.front().Le = {5.0, 2.0, 0.5};
    check_both(scene, "emitting cloud");
}

TEST_CASE("a depth limit equals the reference", "[gpu][image]") {
    for (const std::uint32_t depth : {0u, 1u, 3u}) {
        Scene scene = cloud(thick, 0.95);
        scene.settings.max_depth = depth;
        check_both(scene, fmt::format("cloud, depth {}", depth));
        // Null collisions, too, look for the light.
        check(scene, fmt::format("cloud, depth {}, looks from null collisions", depth), {"ratioNEE"});
    }
}

TEST_CASE("every filter equals the reference", "[gpu][image]") {
    for (const Filter filter : {Filter::nearest, Filter::stochastic}) {
        Scene scene = cloud(thick, 0.9);
        scene.settings.filter = filter;
        check_both(scene, fmt::format("cloud, filter {}", int(filter)));
    }
}

TEST_CASE("quantised grids equal the reference", "[gpu][image][long]") {
    for (const Storage storage : {Storage::fp4, Storage::fp8, Storage::fp16, Storage::fpn}) {
        Scene scene = cloud(thick, 0.9);
        scene.volumes.front().shape = write_grid(cloud_grid(storage));
        check(scene, fmt::format("{} cloud", storage_name(storage)), {"ratioTracking"});
    }
}

TEST_CASE("delta and ratio tracking agree without a light", "[gpu][image]") {
    Scene scene = cloud(thick, 0.95);
    scene.lights.clear();
    scene.settings.integrator = "deltaTracking";
    const Film delta = render_here(scene, 3).film;
    scene.settings.integrator = "ratioTracking";
    CHECK_AGREEMENT(agree(delta, render_here(scene, 4).film, "delta and ratio tracking"));
}

TEST_CASE("majorants change no mean", "[gpu][image][long]") {
    Scene scene = cloud(thick, 0.9);
    const Film usual = render_here(scene, 5).film;
    std::uint32_t seed = 6;
    const auto compare = [&](double scale, int cell) {
        scene.settings.majorant_scale = scale;
        scene.settings.majorant_cell = cell;
        CHECK_AGREEMENT(
            agree(render_here(scene, seed++).film, usual, fmt::format("majorant scale {}, cell {}", scale, cell)));
    };
    for (const int cell : {1, 4, 8, 16, 64})
        compare(1.0, cell);
    compare(2.0, 8);
    compare(8.0, 8);
    compare(1.7, 5);
}
