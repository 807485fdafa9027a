// Grids of colours: albedos that differ from place to place, and glow of any colour, against the reference.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "field_cache.h"
#include "scene_xml.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

// Smaller than the cloud, of another voxel size, rotated against it: a part of the cloud lies beyond.
GridRecipe colors(const std::string& name) {
    GridRecipe grid;
    grid.first = {-6, -5, -4};
    grid.last = {9, 8, 7};
    grid.color = [](glm::ivec3 i) {
        return glm::vec3(0.4f + 0.9f * cloud_noise(i * 3 + 40), 0.9f, 1.2f * cloud_noise(i * 5 + 11));
    };
    grid.name = name;
    const double c = std::cos(0.4), s = std::sin(0.4);
    grid.linear = 0.45 * glm::dmat3(c, s, 0, -s, c, 0, 0, 0, 1);
    grid.translation = {0.2, -0.3, 0.1};
    return grid;
}

GridRecipe numbers(const std::string& name) {
    GridRecipe grid = colors(name);
    grid.color = {};
    grid.value = [](glm::ivec3 i) { return 0.3f + 0.6f * cloud_noise(i * 3 + 40); };
    return grid;
}

// `sigma_a` 0: the grid is the albedo.
Scene colored_cloud(const std::vector<GridRecipe>& grids, double albedo) {
    Volume volume = medium(write_grids(grids), 2.0, albedo, 0.2);
    volume.albedo_grid = "Cd";
    volume.Le = {0.02, 0.03, 0.05};
    Scene scene = scene_of(volume, 11.0, 24, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 192;
    return scene;
}

// A cube of extinction 100 and four units across, seen from in front: what is behind gets exp(-400).
Scene opaque_cube(GridRecipe inner) {
    GridRecipe density{{0, 0, 0},       {19, 19, 19}, [](glm::ivec3) { return 1.0f; }, {}, 0.0f,
                       glm::dmat3(0.2), {-2, -2, -2}};
    inner.linear = density.linear;
    inner.translation = density.translation;
    Scene scene = scene_of(medium(write_grids({density, inner}), 100.0, 0.0), 2.0, 8);
    scene.background = Rgb(9.0);
    scene.settings.spp = 4;
    return scene;
}

} // namespace

TEST_CASE("an albedo by a grid equals the reference", "[gpu][image][color_grids]") {
    const auto check = [](const Scene& scene, const std::string& name) {
        CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), name));
    };
    check(colored_cloud({cloud_grid(), colors("Cd")}, 1.0), "colours");
    check(colored_cloud({cloud_grid(), numbers("Cd")}, 0.9), "numbers");
    Scene scene = colored_cloud({cloud_grid(), colors("Cd")}, 1.0);
    scene.settings.choices.nee = NEE_TENTATIVE;
    scene.settings.choices.emission = EMISSION_AT_STEPS;
    scene.settings.integrator = "ratioTracking";
    check(scene, "at every step");
    scene.settings.choices = {};
    scene.settings.integrator = "rayMarching";
    scene.settings.march.step = 0.1;
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    scene.settings.spp = 4; // of some 1e5 steps each, shadow rays' included, with little noise
    check(scene, "marched through");
}

TEST_CASE("a grid that has one albedo everywhere makes the picture of that number", "[gpu][color_grids]") {
    GridRecipe even = numbers("Cd");
    even.value = [](glm::ivec3) { return 0.25f; };
    Scene number = scene_of(medium(write_grids({cloud_grid(), even}), 2.0, 0.25, 0.7), 11.0, 24, 25.0);
    number.lights = {sunlight()};
    number.settings.integrator = "cachedRatioTracking";
    number.settings.spp = 16;
    number.settings.majorant_cell = 8; // else chosen by the albedo
    Scene grid = number;
    grid.volumes.front().sigma_a = Rgb(0.0);
    grid.volumes.front().sigma_s = Rgb(2.0);
    grid.volumes.front().albedo_grid = "Cd";
    const Film expected = render_here(number, 1).film, film = render_here(grid, 1).film;
    // Paths are the same, but for roundings: what is subtracted from a pixel to calm it has to be so, too. A rounding
    // may turn a choice: once in some 1e7, of which there are 1e5.
    int unlike = 0;
    for (std::size_t i = 0; i < film.mean.size(); ++i)
        unlike += std::abs(film.mean[i].x - expected.mean[i].x) > 1e-4 * mean_of(expected);
    CHECK(unlike <= 1);
}

TEST_CASE("glow and albedo by grids equal the reference", "[gpu][image][color_grids]") {
    Scene scene = colored_cloud({cloud_grid(), colors("Cd"), colors("glow")}, 0.9);
    scene.volumes.front().temperature.color = {1.0, 0.8, 0.5};
    scene.volumes.front().temperature.grid = "glow";
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "three grids"));
    scene.volumes.front().albedo_grid.clear();
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "two grids"));
    scene.volumes.front().temperature.grid = "Cd";
    scene.volumes.front().albedo_grid = "Cd"; // the same one for both
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "one grid twice"));
}

TEST_CASE("voxels of one value each have one glow and one albedo", "[gpu][image][color_grids]") {
    Scene scene = colored_cloud({cloud_grid(), colors("Cd"), colors("glow")}, 0.9);
    scene.settings.filter = Filter::nearest;
    scene.volumes.front().temperature.color = {1.0, 0.8, 0.5};
    scene.volumes.front().temperature.grid = "glow";
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "of colours"));
    // By half at their faces, where they were interpolated.
    GridRecipe density{{0, 0, 0}, {0, 7, 0}, [](glm::ivec3) { return 1.0f; }}, numbers = density, colours = density;
    numbers.name = colours.name = "temperature";
    colours.color = [](glm::ivec3) { return glm::vec3(1.0f); };
    for (const GridRecipe& glow : {numbers, colours}) {
        Scene column = scene_of(medium(write_grids({density, glow}), 40.0, 0.0), 20.0, 4);
        column.volumes.front().temperature.color = Rgb(0.7);
        column.volumes.front().temperature.model = TemperatureEmission::Model::color;
        column.volumes.front().temperature.grid = glow.name;
        column.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
        column.camera.position = {0.1, 20.0, 0.2};
        column.camera.pitch = -90.0;
        column.settings.filter = Filter::nearest;
        column.background = Rgb(0.0);
        for (const glm::vec3& pixel : render_here(column, 1).film.mean)
            CHECK(pixel.x == Approx(0.7).epsilon(1e-5));
    }
}

TEST_CASE("an opaque cube has the radiance of its colours", "[gpu][color_grids]") {
    // Interpolation between equal values and two products: each within a few roundings.
    const auto check = [](const Scene& scene, Rgb radiance) {
        for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
            for (int c = 0; c < 3; ++c)
                CHECK(pixel[c] == Approx(radiance[c]).epsilon(12 * 6e-8));
    };
    GridRecipe glow{glm::ivec3(-4), glm::ivec3(24), nullptr};
    glow.color = [](glm::ivec3) { return glm::vec3(2.0f, 1.0f, 0.25f); };
    glow.name = "glow";
    Scene scene = opaque_cube(glow);
    scene.volumes.front().temperature.color = {3.0, 2.0, 1.0};
    scene.volumes.front().temperature.grid = "glow";
    check(scene, {6.0, 2.0, 0.25});

    // A medium of albedo a, without scattering: (1 - a) Le. Two voxels in the middle of the cube, whose values go on
    // beyond them.
    GridRecipe albedo{glm::ivec3(9), glm::ivec3(10), nullptr};
    albedo.color = [](glm::ivec3) { return glm::vec3(0.25f, 0.5f, 3.0f); };
    albedo.name = "Cd";
    scene = opaque_cube(albedo);
    scene.volumes.front().sigma_a = Rgb(0.0);
    scene.volumes.front().sigma_s = Rgb(100.0);
    scene.volumes.front().Le = {4.0, 4.0, 4.0};
    scene.volumes.front().albedo_grid = "Cd";
    scene.settings.choices.scattering = SCATTERING_NONE;
    check(scene, {3.0, 2.0, 0.0});
}

TEST_CASE("values that are none are counted in every grid", "[gpu][color_grids]") {
    GridRecipe albedo = colors("Cd"), glow = colors("glow");
    albedo.color = [](glm::ivec3 i) { return glm::vec3(i.y == 0 && i.z == 0 && i.x > 6 ? -1.0f : 0.5f, 0.5f, 0.5f); };
    glow.color = [](glm::ivec3 i) { return glm::vec3(i == glm::ivec3(1) ? -1.0f : 0.5f, 0.5f, 0.5f); };
    Scene scene = colored_cloud({cloud_grid(), albedo, glow}, 0.9);
    scene.settings.spp = 1;
    CHECK(render_here(scene, 1).counts.cleaned_voxels == 3);
    scene.volumes.front().temperature.color = Rgb(1.0);
    scene.volumes.front().temperature.grid = "glow";
    CHECK(render_here(scene, 1).counts.cleaned_voxels == 4);
}

TEST_CASE("a grid of albedos that are all 0 is warned of", "[cpu][color_grids]") {
    GridRecipe black = numbers("Cd");
    black.background = 1.0f; // so that what is 0 is there
    black.value = [](glm::ivec3) { return 0.0f; };
    const auto warnings = [](const GridRecipe& albedo) {
        const Scene scene = colored_cloud({cloud_grid(), albedo}, 1.0);
        return load_assets(scene, choose_method(scene)).media.front().warnings;
    };
    REQUIRE(warnings(black).size() == 1);
    CHECK_THAT(warnings(black).front(), Catch::Contains("\"Cd\" is 0 everywhere: the medium absorbs all"));
    CHECK(warnings(numbers("Cd")).empty());
}

TEST_CASE("a grid of albedos above 1 is warned of", "[cpu][color_grids]") {
    GridRecipe bright = numbers("Cd");
    bright.value = [](glm::ivec3) { return 255.0f; };
    const Scene scene = colored_cloud({cloud_grid(), bright}, 1.0);
    const auto warnings = load_assets(scene, choose_method(scene)).media.front().warnings;
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings.front(), Catch::Contains("\"Cd\" has values up to 255, and what is above 1 counts as 1"));
}

TEST_CASE("grids of colours where none can be, and grids that are missing", "[gpu][color_grids]") {
    const GridFile file = write_grids({cloud_grid(), colors("Cd")});
    Scene scene = scene_of(medium(file, 2.0, 0.5), 11.0, 8);
    const auto message = [&] {
        try {
            render_here(scene, 1);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("none");
    };
    Volume& volume = scene.volumes.front();
    volume.albedo_grid = "Cdd";
    CHECK_THAT(message(), Catch::Contains("no grid \"Cdd\"; did you mean \"Cd\"?"));
    volume.albedo_grid.clear();
    volume.temperature.color = Rgb(1.0);
    volume.temperature.grid = "Cd";
    volume.temperature.model = TemperatureEmission::Model::blackbody;
    CHECK_THAT(message(), Catch::Contains("values are colours"));
    volume.temperature = {};
    std::get<GridFile>(volume.shape).grid = "Cd";
    CHECK_THAT(message(), Catch::Contains("values are colours"));
}

TEST_CASE("a kept grid of colours is none of numbers", "[cpu][color_grids]") {
    const GridFile file{write_grids({cloud_grid(), colors("Cd")}).path, "Cd"};
    FieldCache cache;
    cache.take(file, GridValues::numbers_or_colors);
    CHECK_THROWS_AS(cache.take(file), InputError);
    CHECK(cache.take(file, GridValues::numbers_or_colors).type == GRID_COLOR);
}

TEST_CASE("grids of albedos in scene files", "[cpu][xml][color_grids]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options>" + elements + "</options>", "t.xml");
    };
    const std::string field = "<densityField>cloud.nvdb</densityField><sigma_s>1</sigma_s>";
    CHECK(parse(field + R"(<albedo grid="Cd"/>)").volumes.front().albedo_grid == "Cd");
    CHECK(parse(field).volumes.front().albedo_grid.empty());
    CHECK_THROWS_WITH(parse(field + "<albedo/>"), Catch::Contains("lacks grid"));
    CHECK_THROWS_WITH(parse(field + R"(<albedo gird="Cd"/>)"), Catch::Contains("did you mean"));
    const Scene ball = parse(R"(<sphere radius="1"/><albedo grid="Cd"/>)");
    CHECK(ball.volumes.front().albedo_grid.empty());
    CHECK_THAT(ball.warnings.front(), Catch::Contains("<albedo> is without effect"));
}
