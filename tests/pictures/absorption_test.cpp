// What is absorbed, by layer, by voxel and in all, against closed forms and fluences.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <numbers>

#include "density_field.h"
#include "error.h"
#include "method.h"
#include "preset.h"
#include "reading_grid.h"
#include "scene_hash.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/surface_scenes.h"
#include "tests/reference/reference.h"
#include "tests/reference/transport.h"

using namespace vkvol;
using Catch::Contains;
using std::numbers::pi;

TEST_CASE("what a slab absorbs, layer by layer", "[gpu][counted]") {
    constexpr int cells = 8, fine = 800;
    const double tau = 2.0, albedo = GENERATE(0.0, 0.6, 0.95), mu0 = GENERATE(1.0, 0.3);
    const reference::SlabSolution beam = reference::slab_in_beam(albedo, tau, mu0, fine);
    Scene scene = absorption({0.1, -0.5, -0.2}, glm::dvec3(1.0), {2, cells, 3}, 2048);
    scene.volumes = {medium(Box{{0.0, -0.5, 0.0}, glm::dvec3(1.0)}, tau, albedo)};
    scene.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
    scene.lights = {DirectionalLight{{std::sqrt(1.0 - mu0 * mu0), mu0, 0.0}, Rgb(1.0)}};
    std::vector<Rgb> means;
    double sum = 0.0;
    for (int y = 0; y < 3 * cells; ++y) { // the uppermost first
        double fluence = 0.0;
        for (int i = 0; i < fine / cells; ++i)
            fluence += beam.fluence[std::size_t(y % cells * fine / cells + i)] * cells / fine;
        means.insert(means.end(), 2, Rgb(tau * (1.0 - albedo) * fluence));
        sum += means.back().x / (3.0 * cells);
    }
    CHECK(beam.reflected + beam.transmitted + sum == Approx(mu0).epsilon(2e-4)); // of the solution
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 1).film, means, fmt::format("slab of {}, {}", albedo, mu0)));
}

// In a furnace as much as is emitted: radiance 1 from everywhere. So each cell reads the grid's own voxel.
TEST_CASE("what voxels absorb in a furnace, and the grid of it", "[gpu][counted]") {
    const glm::ivec3 dims(5, 3, 4);
    GridRecipe recipe;
    recipe.first = {0, 0, 0};
    recipe.last = dims - 1;
    recipe.linear = glm::dmat3(0.5);
    recipe.value = [](glm::ivec3 v) { return 0.2f + 0.1f * float(v.x) + 0.5f * float(v.y == 1) + 0.3f * float(v.z); };
    const bool chromatic = GENERATE(false, true);
    Volume volume = medium(write_grid(recipe), 1.0, 0.5);
    volume.sigma_a = chromatic ? Rgb(0.3, 0.5, 0.6) : Rgb(0.5);
    volume.sigma_s = chromatic ? Rgb(0.4, 0.4, 0.2) : Rgb(0.5);
    volume.Le = Rgb(1.0);
    const glm::dvec3 edges = 0.5 * glm::dvec3(dims);
    Scene scene = absorption(0.5 * edges - 0.25, edges, dims, 1 << 13);
    scene.volumes = {volume};
    scene.background = Rgb(1.0);
    scene.settings.filter = Filter::nearest;
    std::vector<Rgb> means;
    for (int y = 0; y < dims.y * dims.z; ++y)
        for (int x = 0; x < dims.x; ++x)
            means.push_back(4.0 * pi * volume.sigma_a * double(recipe.value({x, dims.y - 1 - y % dims.y, y / dims.y})));
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, means, fmt::format("furnace, {}", chromatic)));
    const std::string bytes = reading_grid(film, scene.camera, "a.nvdb");
    if (!chromatic) {
        const std::filesystem::path file = std::filesystem::path(write_text("")).replace_extension(".nvdb");
        std::ofstream(file, std::ios::binary) << bytes;
        const reference::Grid grid = reference::load_grid(file, "absorbed");
        const glm::dvec3 place = grid.linear * glm::dvec3(3.0, 2.0, 1.0) + grid.translation;
        CHECK(glm::distance(place, scene.camera.cell_low({3, 2, 1}) + 0.25) < 1e-12);
        CHECK(grid.voxel({3, 2, 1}) == film.mean[std::size_t(1 * dims.y + 0) * 5 + 3].x);
        CHECK(grid.voxel({4, 0, 3}) == film.mean[std::size_t(3 * dims.y + 2) * 5 + 4].x);
        const reference::Grid errors = reference::load_grid(file, "absorbed_error");
        CHECK(errors.voxel({4, 0, 3}) == std::sqrt(film.variance[std::size_t(3 * dims.y + 2) * 5 + 4].x));
    }
}

TEST_CASE("what is absorbed is one grid as .nvdb and as .vdb", "[cpu][counted]") {
    Camera camera;
    camera.projection = Projection::absorption;
    camera.cells = {3, 2, 2};
    camera.edges = {3.0, 1.0, 2.0};
    camera.position = {1.0, -2.0, 0.5};
    Film film;
    film.picture_width = 3;
    film.picture_height = 4;
    film.crop = {0, 3, 0, 4};
    for (int i = 0; i < 12; ++i) {
        film.mean.emplace_back(float(i) / 8.0f);
        film.variance.emplace_back(float(i) / 64.0f);
        film.samples.push_back(9);
    }
    const bool is_colored = GENERATE(false, true);
    if (is_colored)
        film.mean[7].y = 3.0f;
    for (const char* ending : {".nvdb", ".vdb"}) {
        CAPTURE(ending, is_colored);
        const std::filesystem::path file = std::filesystem::path(write_text("")).replace_extension(ending);
        std::ofstream(file, std::ios::binary) << reading_grid(film, camera, file);
        const DensityField absorbed = load_density_field(GridFile{file, "absorbed"}, GridValues::numbers_or_colors),
                           error = load_density_field(GridFile{file, "absorbed_error"}, GridValues::numbers_or_colors);
        CHECK(glm::distance(glm::dvec3(absorbed.index_to_world * glm::dvec4(2.0, 1.0, 1.0, 1.0)),
                            camera.cell_low({2, 1, 1}) + 0.5 * camera.cell_size()) < 1e-6);
        for (int i = 0; i < 12; ++i) {
            const glm::ivec3 cell = camera.cell_of_pixel(i % 3, i / 3);
            CHECK(absorbed.color(cell) == film.mean[std::size_t(i)]);
            CHECK(error.color(cell) == glm::sqrt(film.variance[std::size_t(i)]));
        }
    }
    film.samples[3] = 1; // whose error is not known
    const std::filesystem::path file = std::filesystem::path(write_text("")).replace_extension(".vdb");
    std::ofstream(file, std::ios::binary) << reading_grid(film, camera, file);
    CHECK_THROWS_AS(load_density_field(GridFile{file, "absorbed_error"}), InputError);
}

TEST_CASE("absorption amid several media with surfaces, beneath lights of all kinds", "[gpu][counted][long]") {
    const LightsAbout lights;
    Scene scene = absorption({0.0, 0.0, 0.0}, glm::dvec3(1.2), {8, 8, 8}, 1024);
    scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 0.5, 0.6, 0.3),
                     medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(1.2)}, 1.0, 0.8)};
    scene.surfaces = {surface_of(left_ball, MaterialKind::diffuse, 0.0)};
    scene.lights = {lights.point, lights.beam, lights.rectangle, lights.sun};
    const ImageMean in_all = image_mean(render_here(scene, 1).film);
    // As much as the fluence of points all over the box says, times both media's sigma_a.
    scene.camera.projection = Projection::fluence;
    for (int i = 0; i < 4096; ++i) // of a lattice of rank 1, whose error is far below the noise
        scene.camera.points.push_back(
            1.2 * (glm::fract(glm::dvec3(i, 1183.0 * i, 1969.0 * i) / 4096.0 + 0.5 / 4096.0) - 0.5));
    scene.picture = {64, 64, 0.0, 0.0, 64.0, 64.0};
    scene.settings.spp = 64;
    const Film fluence = render_here(by(scene, "ratioTracking"), 2).film;
    for (int channel = 0; channel < 3; ++channel) {
        double sum = 0.0, variance = 0.0;
        const double read = in_all.value[channel], spread = (*in_all.standard_error)[channel];
        for (std::size_t i = 0; i < 4096; ++i) {
            sum += fluence.mean[i][channel] / 4096.0;
            variance += fluence.variance[i][channel] / (4096.0 * 4096.0);
        }
        const double sigma_a = 0.5 * 0.4 + 1.0 * 0.2;
        const double error = std::sqrt(sigma_a * sigma_a * variance + spread * spread);
        CAPTURE(channel, sigma_a * sum, read, error);
        CHECK(std::abs(sigma_a * sum - read) < 4.0 * error);
        CHECK(error < 0.02 * sigma_a * sum);
    }
}

// Whatever the unit of length, and however little of a particle a collision takes.
TEST_CASE("the error of absorbed power is known where little is absorbed", "[gpu][counted]") {
    std::vector<double> relative;
    for (const double unit : {1e-6, 1.0, 1e4}) {
        Scene scene = absorption({0.0, 0.0, 0.0}, glm::dvec3(unit), {1, 5, 1}, 2048);
        scene.volumes = {medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(unit)}, 2.0 / unit, 1.0 - 1e-5)};
        scene.periodic = Periodic{{-0.5 * unit, 0.0, -0.5 * unit}, {0.5 * unit, 0.0, 0.5 * unit}};
        scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
        const Film film = render_here(scene, 1).film;
        const ImageMean mean = image_mean(film);
        REQUIRE(mean.standard_error);
        CAPTURE(unit, mean.value.x, mean.standard_error->x);
        CHECK(mean.value.x * unit > 1e-5);
        CHECK(mean.value.x * unit < 4e-5);
        relative.push_back(mean.standard_error->x / mean.value.x);
    }
    for (const double error : relative) { // as of any other unit, to what 2048 samples tell of it
        CHECK(error > 1e-4);
        CHECK(std::abs(error / relative.front() - 1.0) < 0.25);
    }
}

TEST_CASE("what is absorbed is known to all digits", "[gpu][counted]") {
    const auto absorbed = [](double share) { // of what collides, by nearly the same paths
        Scene scene = absorption({0.0, 0.0, 0.0}, glm::dvec3(1.0), {1, 1, 1}, 2048);
        scene.volumes = {medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(1.0)}, 2.0, 1.0 - share)};
        scene.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
        scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
        return image_mean(render_here(scene, 1).film).value.x / share;
    };
    const double usual = absorbed(1e-4);
    for (const double share : {1e-6, 1e-8})
        CHECK(absorbed(share) == Approx(usual).epsilon(2e-3));
    // Likewise where the albedo varies from place to place.
    const auto of_layers = [](double share) {
        const std::string layer = fmt::format(R"(sigma_t="2" albedo="{:.17g}"/>)", 1.0 - share);
        const Scene scene = parse_scene(
            R"(<options><periodic x="-.5 .5" z="-.5 .5"/><box width="1" height="1" depth="1"/><layers><layer height="-.5" )" +
                layer + R"(<layer height=".5" )" + layer +
                R"(</layers><light y="1" r="1" g="1" b="1"/><absorption width="1" height="1" depth="1"/>
                <rayPerPixelCount>2048</rayPerPixelCount></options>)",
            "s.xml");
        return image_mean(render_here(scene, 1).film).value.x / share;
    };
    const double usual_layers = of_layers(1e-4);
    CHECK(usual_layers == Approx(usual).epsilon(0.05)); // by other paths
    for (const double share : {1e-6, 1e-8})
        CHECK(of_layers(share) == Approx(usual_layers).epsilon(2e-3));
}

TEST_CASE("boxes in which absorption is read, in scene files", "[cpu][counted]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options><sphere/><sigma_a>1</sigma_a>" + elements + "</options>", "s.xml");
    };
    const Scene scene = parse(R"(<absorption x="1" width="4" height="3" depth="2" cells="8 3 5"/>)");
    CHECK(scene.camera.edges == glm::dvec3(4.0, 3.0, 2.0));
    CHECK(scene.picture.width == 8);
    CHECK(scene.picture.height == 15);
    CHECK(scene.camera.cell_of_pixel(2, 4) == glm::ivec3(2, 1, 1));
    CHECK(glm::distance(scene.camera.cell_low({7, 0, 0}), glm::dvec3(2.5, -1.5, -1.0)) < 1e-12);
    CHECK(choose_method(with_preset(scene)).paths == PATHS_LIGHT);
    CHECK_THROWS_WITH(choose_method(with_preset(by(scene, "ratioTracking"))), Contains("take integrator lightTracing"));
    CHECK(scene_hash(scene) !=
          scene_hash(parse(R"(<absorption x="1" width="4" height="3" depth="2.5" cells="8 3 5"/>)")));
    CHECK_THROWS_WITH(parse(R"(<absorption cells="1 2"/>)"), Contains("three numbers"));
    CHECK_THROWS_WITH(parse(R"(<absorption cells="1 2 2.5"/>)"), Contains("three whole numbers"));
    CHECK_THROWS_WITH(parse(R"(<absorption cells="1 1000 1000"/>)"), Contains("at most"));
    CHECK_THROWS_WITH(parse(R"(<absorption/><width>3</width>)"),
                      Contains("<width>: <absorption> has a pixel for each"));
    CHECK_THROWS_WITH(parse(R"(<absorption/><camera/>)"), Contains("<absorption> beside the <camera>"));
    Scene resized = scene;
    CHECK_THROWS_WITH(resize_picture(resized, 9, std::nullopt), Contains("each of its cells"));
    CHECK_THROWS_WITH(check_grid_file("a.nvdb", Camera{}, false), Contains("take .exr"));
}

TEST_CASE("a grid of what is absorbed has all its cells", "[cpu][counted]") {
    Camera camera;
    camera.projection = Projection::absorption;
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "absorbed.nvdb";
    CHECK_NOTHROW(check_grid_file(file, camera, false));
    CHECK_THROWS_WITH(check_grid_file(file, camera, true), Contains("leave --crop out"));
}
