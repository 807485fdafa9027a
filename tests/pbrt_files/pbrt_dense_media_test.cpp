// Media of pbrt-v4 whose densities are in no file. What pbrt itself would do is written out here from its book and
// source.
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "blackbody.h"
#include "density_field.h"
#include "error.h"
#include "loaded_medium.h"
#include "pbrt_cloud.h"
#include "pbrt_scenes.h"
#include "scene_hash.h"
#include "support/images.h"
#include "support/test_directory.h"

using namespace vkvol;
using Catch::Contains;

namespace {

std::string grid_medium(const std::string& parameters) {
    return "MakeNamedMedium \"a b/c\" \"string type\" \"uniformgrid\" " + parameters +
           "\nMaterial \"interface\" MediumInterface \"a b/c\" \"\" Shape \"sphere\" \"float radius\" 99\n";
}

// 2 x 3 x 4 voxels, whose values say where they are.
const std::string numbered = [] {
    std::string text = "\"integer nx\" 2 \"integer ny\" 3 \"integer nz\" 4 \"float density\" [";
    for (int i = 0; i < 24; ++i)
        text += fmt::format(" {}", i);
    return text + " ]";
}();

const Volume& only_medium(const Scene& scene) {
    REQUIRE(scene.volumes.size() == 1);
    return scene.volumes.front();
}

DensityField field_of(const Volume& volume) {
    DensityField field = load_density_field(std::get<GridFile>(volume.shape));
    field.place(volume.transform);
    return field;
}

} // namespace

TEST_CASE("pbrt's grids within scenes have their values in their places", "[cpu][pbrt]") {
    const Scene scene =
        world_of("Translate 10 0 0 " +
                 grid_medium(numbered + " \"point3 p0\" [ -1 -2 -3 ] \"point3 p1\" [ 1 4 5 ] \"float "
                                        "scale\" 2 \"spectrum sigma_a\" [ 200 .5 900 .5 ] \"float g\" .3"));
    const Volume& volume = only_medium(scene);
    CHECK(std::get<GridFile>(volume.shape).path.filename() == "a_b_c.nvdb");
    CHECK(near(volume.sigma_a, glm::dvec3(1.0)));
    CHECK(near(volume.sigma_s, glm::dvec3(2.0)));
    CHECK(volume.unit == CoefficientUnit::world);
    const DensityField field = field_of(volume);
    CHECK(field.active_voxels == 24); // also the first, a corner, which is 0
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 2; ++x) {
                CHECK(field.value({x, y, z}) == float(x + 2 * y + 6 * z));
                // Voxels of 1 x 2 x 2; the world here has z the other way.
                const glm::dvec3 here(field.index_to_world * glm::dvec4(x, y, z, 1.0));
                CHECK(near(here, {10.0 - 0.5 + x, -1.0 + 2.0 * y, -(-2.0 + 2.0 * z)}));
            }
    // The values count in what a checkpoint knows the scene by.
    const Scene other = world_of("Translate 10 0 0 " + grid_medium("\"float density\" 2"));
    const Scene third = world_of("Translate 10 0 0 " + grid_medium("\"float density\" 3"));
    CHECK(scene_hash(other) != scene_hash(third));
    // Two media of names that files cannot tell apart, and a cache that is asked for both.
    const Scene two = world_of(grid_medium("\"float density\" 2") +
                               "MakeNamedMedium \"a_b_c\" \"string type\" \"uniformgrid\" \"float density\" 3 "
                               "MediumInterface \"a_b_c\" \"\" Shape \"sphere\"");
    REQUIRE(two.volumes.size() == 2);
    FieldCache cache;
    CHECK(cache.take(std::get<GridFile>(two.volumes[0].shape)).value({0, 0, 0}) == 2.0f);
    CHECK(cache.take(std::get<GridFile>(two.volumes[1].shape)).value({0, 0, 0}) == 3.0f);
    CHECK(cache.take(std::get<GridFile>(only_medium(other).shape)).value({0, 0, 0}) == 2.0f);
    CHECK(cache.take(std::get<GridFile>(only_medium(third).shape)).value({0, 0, 0}) == 3.0f);
}

TEST_CASE("pbrt's grids within scenes glow", "[cpu][pbrt]") {
    const std::string eight =
        "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"float density\" [ 1 1 1 1 1 1 1 1 ] ";
    const Volume even = only_medium(world_of(grid_medium(eight + "\"rgb Le\" [ 2 2 2 ]")));
    const Volume varied =
        only_medium(world_of(grid_medium(eight + "\"rgb Le\" [ 2 2 2 ] \"float Lescale\" [ 0 1 2 3 4 5 6 7 ]")));
    CHECK(near(varied.temperature.color, even.temperature.color));
    CHECK((even.temperature.color.x > 0.0 && even.temperature.model == TemperatureEmission::Model::color));
    // pbrt's usual scale is a grid of one voxel: 1 - |x - 1/2| along each axis. Here it has 24 of them along the box,
    // the first before it.
    const DensityField scales = load_density_field(std::get<GridFile>(even.shape).beside("Lescale"));
    const auto tent = [](int voxel) { return 1.0 - std::abs((voxel - 0.5) / 24.0 - 0.5); };
    for (const glm::ivec3 voxel : {glm::ivec3(0, 1, 2), glm::ivec3(13, 12, 11), glm::ivec3(25, 24, 7)})
        CHECK(scales.value(voxel) == Approx(tent(voxel.x) * tent(voxel.y) * tent(voxel.z)));
    CHECK(varied.temperature.grid == "Lescale");
    CHECK(has_grid(std::get<GridFile>(varied.shape).beside("Lescale")));
}

// pbrt's (temperature - offset) * scale, linear between the middles of voxels, is a black body divided by its maximum,
// from 100 kelvin on, and that times the scale of Le, which is linear likewise.
TEST_CASE("what burns in pbrt's grids glows as its black body times the scale of Le", "[cpu][pbrt]") {
    const std::string hot = "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"float density\" [ 1 1 1 1 1 1 1 1 ] "
                            "\"float temperature\" [ 0 100 200 300 400 500 600 700 ] \"float temperaturescale\" 3 "
                            "\"float temperatureoffset\" 50 ";
    const Volume usual = only_medium(world_of(grid_medium(hot)));
    const Volume scaled = only_medium(world_of(grid_medium(hot + "\"float Lescale\" [ 0 1 2 3 4 5 6 7 ]")));
    CHECK((usual.temperature.model == TemperatureEmission::Model::color && usual.temperature.grid == "glow"));
    // Twelve voxels for each of the density's: middles 1/24 of one beside what is half-way between these. The values
    // grow along x + 2 y + 4 z.
    for (const double along : {0.5 - 1.0 / 24.0, 0.5 + 1.0 / 24.0, 1.0 / 24.0}) {
        const auto glow_there = [&](const Volume& volume) {
            const GridFile file = std::get<GridFile>(volume.shape);
            const DensityField density = load_density_field(file);
            const DensityField glow = load_density_field(file.beside("glow"), GridValues::vectors);
            const glm::dvec3 fine(glm::inverse(glow.index_to_world) * density.index_to_world *
                                  glm::dvec4(glm::dvec3(along), 1.0));
            CHECK(glm::length(fine - glm::round(fine)) < 1e-5);
            return volume.temperature.color * glm::dvec3(glow.color(glm::ivec3(glm::round(fine))));
        };
        const double value = 7.0 * along, kelvin = 3.0 * (100.0 * value - 50.0),
                     side = 1.0 - std::abs(along / 2.0 - 0.25);
        const glm::dvec3 black_body = kelvin > 100.0 ? blackbody_rgb(kelvin, 0.0) : glm::dvec3(0.0);
        CAPTURE(along, kelvin);
        // pbrt's usual scale: 1 - |x - 1/2| along each axis. The table of colours has 0.5 kelvin for a step.
        CHECK(near(glow_there(usual), usual.temperature.color * black_body * side * side * side, 1e-3));
        CHECK(near(glow_there(scaled), scaled.temperature.color * black_body * value, 1e-3));
    }
}

TEST_CASE("pbrt's clouds have pbrt's densities", "[cpu][pbrt]") {
    // By pbrt's own functions, compiled apart: the usual cloud, and one of density 2, wispiness 0.3 and frequency 8.
    struct Known {
        glm::dvec3 place;
        double usual, other;
    };
    for (const Known& known : {Known{{0.3, 0.6, 0.2}, 0.260506, 0.0}, Known{{-1.7, 0.55, 2.4}, 0.235200, 0.057824},
                               Known{{0.91, 0.72, -0.33}, 0.232164, 0.0}, Known{{5.2, 0.51, -7.7}, 0.0, 0.0},
                               Known{{-0.4, 0.62, 0.7}, 0.0, 0.607917}, Known{{12.3, 0.45, 3.1}, 0.940083, 0.1},
                               Known{{-0.77, 0.58, -0.21}, 0.168321, 0.823722}}) {
        // In single precision, differentiated over 0.01: to some 1e-4.
        CHECK(PbrtCloud{}.at(known.place) == Approx(known.usual).margin(2e-3));
        CHECK(PbrtCloud{2.0, 0.3, 8.0}.at(known.place) == Approx(known.other).margin(2e-3));
    }
    const Scene scene =
        world_of("MakeNamedMedium \"c\" \"string type\" \"cloud\" \"point3 p0\" [ -1 .4 0 ] \"point3 p1\" "
                 "[ 1 .9 .5 ] \"float frequency\" 6 MediumInterface \"c\" \"\" Material \"interface\" "
                 "Shape \"sphere\" \"float radius\" 99");
    const Volume& volume = only_medium(scene);
    const DensityField field = field_of(volume);
    // 2.5 voxels for a cell of the finest of its octaves, which are 6, 6 1.99, ... 6 1.99^4 in a unit of length.
    const glm::ivec3 last(std::lround(2.5 * 6.0 * std::pow(1.99, 4) * 2.0) - 1,
                          std::lround(2.5 * 6.0 * std::pow(1.99, 4) * 0.5) - 1,
                          std::lround(2.5 * 6.0 * std::pow(1.99, 4) * 0.5) - 1);
    for (const glm::ivec3 voxel : {glm::ivec3(0, 0, 0), last, glm::ivec3(100, 20, 30)}) {
        const glm::dvec3 here(field.index_to_world * glm::dvec4(voxel, 1.0));
        CHECK(field.value(voxel) == Approx(PbrtCloud{1.0, 1.0, 6.0}.at({here.x, here.y, -here.z})).margin(1e-6));
    }
    CHECK((field.voxel_max.x == last.x && field.voxel_max.z == last.z));
    REQUIRE(scene.warnings.size() == 1); // of the camera within the sphere
    CHECK_THAT(scene.warnings.front(), Contains("sees the grid of medium"));
}

TEST_CASE("grids of pbrt that cannot be quite as there are noted", "[cpu][pbrt]") {
    const auto noted = [](const Scene& scene, const std::string& text) {
        return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                           [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
    };
    CHECK(noted(world_of(grid_medium("\"float density\" 1")), "within half a voxel beyond its bounds"));
    CHECK_FALSE(
        noted(world_of(grid_medium("\"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3 \"float density\" [ 0 0 0 0 0 0 "
                                   "0 0 0 0 0 0 0 1 0 0 0 0 0 0 0 0 0 0 0 0 0 ]")),
              "half a voxel"));
    PbrtTranslationOptions few;
    few.most_cloud_voxels = 30000;
    const PbrtTranslation coarse = translate_pbrt(
        read_pbrt("WorldBegin MakeNamedMedium \"c\" \"string type\" \"cloud\" MediumInterface \"c\" \"\" Material "
                  "\"interface\" Shape \"sphere\" \"float radius\" 99",
                  "s.pbrt"),
        few);
    REQUIRE(coarse.notes.size() == 2); // of the camera's medium, too
    CHECK_THAT(coarse.notes.front(), Contains("s.pbrt:1:") && Contains("finer than its grid of 31 x 31 x 31 voxels"));
}

TEST_CASE("a mesh that cuts a grid of pbrt is noted, and one about it is not", "[cpu][pbrt]") {
    const auto is_noted = [](double radius, const std::string& more) {
        const std::string r = fmt::format("{}", radius);
        const Scene scene =
            world_of("MakeNamedMedium \"g\" \"string type\" \"uniformgrid\" \"float density\" 1 \"point3 p0\" [ -1 -1 "
                     "-1 ] \"point3 p1\" [ 1 1 1 ] MediumInterface \"g\" \"\" Material \"interface\" " +
                     more + " Shape \"trianglemesh\" \"point3 P\" [ " + r + " 0 0 -" + r + " 0 0 0 " + r + " 0 0 -" +
                     r + " 0 0 0 " + r + " 0 0 -" + r +
                     " ] \"integer indices\" [ 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 "
                     "0 3 5 ]");
        return std::any_of(scene.warnings.begin(), scene.warnings.end(), [](const std::string& warning) {
            return warning.find("shapes do not cut grids") != std::string::npos;
        });
    };
    CHECK(is_noted(1.01, "")); // its corners are out, of an octahedron whose bounds are beyond the box
    CHECK(is_noted(2.9, ""));
    CHECK_FALSE(is_noted(3.1, ""));
}

TEST_CASE("wrong media of pbrt are refused with their place", "[cpu][pbrt]") {
    const auto refused = [](const std::string& parameters, const std::string& reason) {
        CHECK_THROWS_WITH(world_of(grid_medium(parameters)), Contains(reason) && Contains("s.pbrt:3:"));
    };
    refused("", "0 values of \"density\"; expected nx ny nz = 1");
    refused("\"integer nx\" 2 \"float density\" [ 1 2 3 ]", "3 values of \"density\"; expected nx ny nz = 2");
    refused("\"integer nx\" 0 \"float density\" 1", "nx is 0; expected 1 to 4096");
    refused("\"integer nz\" 5000 \"float density\" 1", "nz is 5000");
    refused("\"float density\" -1", "has -1 among its values");
    refused("\"float density\" 1 \"point3 p1\" [ 1 0 1 ]", "p0 and p1 enclose nothing");
    refused("\"float density\" 1 \"float temperature\" [ 1 2 ]", "2 values of \"temperature\"");
    refused("\"float density\" 1 \"float temperature\" 1 \"rgb Le\" [ 1 1 1 ]", "both \"Le\" and \"temperature\"");
    CHECK_THROWS_WITH(
        world_of("MakeNamedMedium \"c\" \"string type\" \"cloud\" \"float frequency\" -3 MediumInterface \"c\" "
                 "\"\" Shape \"sphere\""),
        Contains("frequency is -3; expected 0 to 1e+06"));
}

TEST_CASE("what is below 0 in pbrt's grids of temperatures and scales does not glow", "[cpu][pbrt]") {
    const std::string eight =
        "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"float density\" [ 1 1 1 1 1 1 1 1 ] ";
    const Scene below = world_of(grid_medium(eight + "\"rgb Le\" [ 2 2 2 ] \"float Lescale\" [ -3 1 2 3 4 5 6 7 ]"));
    CHECK(std::count_if(below.warnings.begin(), below.warnings.end(), [](const std::string& warning) {
              return warning.find("values below 0 are 0 here") != std::string::npos;
          }) == 1);
    const DensityField scales = load_density_field(std::get<GridFile>(only_medium(below).shape).beside("Lescale"));
    CHECK(scales.value({0, 0, 0}) == 0.0f);
    CHECK(scales.value({1, 0, 0}) == 1.0f);
    // Degrees, of which pbrt makes kelvins: (temperature + 273) * 1.
    const Volume warm = only_medium(
        world_of(grid_medium(eight + "\"float temperature\" [ -200 900 900 900 900 900 900 900 ] "
                                     "\"float temperatureoffset\" -273 \"float Lescale\" [ -1 1 1 1 1 1 1 1 ]")));
    CHECK(warm.temperature.grid == "glow");
}
