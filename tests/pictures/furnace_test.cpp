// Furnaces: nothing absorbs, and the same radiance comes from everywhere, so it must be seen everywhere. Paths that
// escape carry exactly the background; no tolerance is due.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

// Its squares are exact in single precision, so that the variance must be 0 too.
constexpr Rgb glow{0.5, 1.0, 1.5};

Scene furnace(const Volume& volume, std::uint32_t samples = 16) {
    Scene scene = scene_of(volume, 3.0, 16, 8.0, glm::dvec3(0.0), {20.0, 30.0, 10.0});
    scene.background = glow;
    scene.settings.spp = samples;
    return scene;
}

void check_equals_background(const Scene& scene) {
    const RenderResult result = render_here(scene, 3);
    CHECK(result.counts.real_collisions > 0);
    const Film& film = result.film;
    const auto count = [](const std::vector<glm::vec3>& values, glm::vec3 value) {
        return std::count(values.begin(), values.end(), value);
    };
    CHECK(count(film.mean, glm::vec3(glow)) == std::ptrdiff_t(film.pixel_count()));
    CHECK(count(film.variance, glm::vec3(0.0f)) == std::ptrdiff_t(film.pixel_count()));
}

// About the world's origin, 2.7 units across, optical depth about 6.
Volume cloud(Storage storage, double g) {
    GridRecipe grid = cloud_grid(storage);
    grid.linear *= 0.3;
    grid.translation *= 0.3;
    return medium(write_grid(grid), 8.0, 1.0, g);
}

} // namespace

TEST_CASE("a homogeneous furnace shows its background exactly", "[gpu][hard][furnace]") {
    const double g = GENERATE(0.0, 0.8, -0.8);
    CAPTURE(g);
    check_equals_background(furnace(medium(Sphere{}, 3.0, 1.0, g)));
    check_equals_background(furnace(medium(Box{{0.1, 0.2, -0.1}, {1.0, 2.0, 1.5}}, 3.0, 1.0, g)));
}

TEST_CASE("a furnace with a grid shows its background exactly", "[gpu][hard][furnace][long]") {
    const double g = GENERATE(0.0, 0.8, -0.8);
    const Storage storage = GENERATE(Storage::float32, Storage::fp8);
    const Filter filter = GENERATE(Filter::nearest, Filter::trilinear, Filter::stochastic);
    CAPTURE(g, int(storage), int(filter));
    Scene scene = furnace(cloud(storage, g), 4);
    scene.settings.filter = filter;
    check_equals_background(scene);
}

TEST_CASE("a furnace seen from inside shows its background exactly", "[gpu][hard][furnace]") {
    for (const Volume& volume :
         {medium(Sphere{}, 3.0, 1.0, 0.5), medium(Box{}, 3.0, 1.0), cloud(Storage::float32, 0.5)}) {
        Scene scene = furnace(volume);
        scene.camera.position = glm::dvec3(0.05, -0.1, 0.07);
        scene.camera.fov = 120.0;
        check_equals_background(scene);
    }
}

// Paths that would scatter more than D times are lost: L = L_b (1 - P[more than D scatterings]).
TEST_CASE("a depth limit darkens a furnace by the paths it ends", "[gpu][hard][furnace]") {
    for (const Volume& volume : {medium(Sphere{}, 2.0, 1.0, 0.5), cloud(Storage::float32, 0.5)})
        for (const std::uint32_t depth : {0u, 1u, 4u}) {
            Scene scene = furnace(volume, 256);
            scene.settings.max_depth = depth;
            const RenderResult result = render_here(scene, 4);
            CHECK(result.counts.depth_caps > 0);
            std::ptrdiff_t above = 0;
            for (const glm::vec3& pixel : result.film.mean)
                above += glm::any(glm::greaterThan(pixel, glm::vec3(glow)));
            CHECK(above == 0);
            CHECK_AGREEMENT(agree(result.film, render_reference(scene, 5),
                                  fmt::format("furnace {}, depth {}", volume.shape.index(), depth)));
        }
}
