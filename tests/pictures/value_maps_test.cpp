// Maps from a grid's values to densities, and transfer functions: against the reference, against grids that hold what
// the map makes of them, and how scene files say them.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "error.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_medium.h"
#include "support/thorough.h"
#include "tests/reference/mapped.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// For values from 0 to 1, of which 0 is not nothing: the grid's box is full of haze.
ValueMap tissues() {
    ValueMap map;
    map.points = {{0.0, 0.03, Rgb(0.9), Rgb(0.0)},
                  {0.2, 0.1, {0.9, 0.6, 0.4}, Rgb(0.0)},
                  {0.45, 1.5, {0.8, 0.7, 0.6}, {0.5, 0.1, 0.02}},
                  {0.45, 0.4, {1.0, 0.95, 0.9}, Rgb(0.0)},
                  {0.8, 2.5, {0.3, 0.4, 0.9}, {0.0, 0.0, 0.2}}};
    map.is_transfer = true;
    return map;
}

Volume mapped_cloud(const ValueMap& map, double sigma_t = 1.0, double albedo = 0.9) {
    Volume volume = medium(write_grids({cloud_grid()}), sigma_t, map.is_transfer ? 1.0 : albedo, 0.2);
    volume.map = map;
    return volume;
}

Scene lit_by_sun(const Volume& volume, double width = 11.0) {
    Scene scene = scene_of(volume, width, 16, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 128;
    return scene;
}

ValueMap ramp_of(const std::string& attributes) {
    return parse("<densityField>cloud.nvdb</densityField><densityMap " + attributes + "/>").volumes.front().map;
}

const std::string field_to_map = "<densityField>cloud.nvdb</densityField>";

} // namespace

TEST_CASE("mapped values equal the reference", "[gpu][image][value_map]") {
    std::vector<std::pair<const char*, Scene>> all = {{"map", lit_by_sun(mapped_cloud(bumpy_map(), 1.5))},
                                                      {"transfer function", lit_by_sun(mapped_cloud(tissues()))}};
    Scene scene = lit_by_sun(mapped_cloud(tissues()));
    scene.volumes.front().Le = {0.02, 0.03, 0.05};
    scene.settings.integrator = "ratioTracking";
    scene.settings.choices.nee = NEE_TENTATIVE;
    scene.settings.choices.emission = EMISSION_AT_STEPS;
    all.emplace_back("at every step", scene);
    scene.settings.filter = Filter::nearest;
    all.emplace_back("nearest", scene);
    scene.settings.choices = {};
    scene.settings.integrator = "regularTracking";
    all.emplace_back("nearest, regular", scene);
    scene.settings.filter = Filter::trilinear;
    scene.settings.integrator = "nanoVDBEmission";
    all.emplace_back("marched through", scene);
    for (const auto& [name, each] : in_turn(all, 1, 2))
        check_against_reference(each, name);
}

TEST_CASE("a map of each voxel equals a grid that holds what it makes of them", "[gpu][image][value_map][long]") {
    GridRecipe baked = cloud_grid();
    baked.value = [](glm::ivec3 i) { return float(reference::mapped(bumpy_map(), cloud_noise(i)).density); };
    Scene map = lit_by_sun(mapped_cloud(bumpy_map(), 1.5));
    map.settings.filter = Filter::nearest;
    Scene grid = map;
    grid.volumes.front() = medium(write_grids({baked}), 1.5, 0.9, 0.2);
    const std::vector<std::string> integrators = {
        "ratioTracking",       "cachedRatioTracking",   "regularTracking", "decompositionTracking",
        "unbiasedRayMarching", "residualRatioTracking", "weightedTracking"};
    for (const std::string& integrator : in_turn(integrators, 2)) {
        map.settings.integrator = grid.settings.integrator = integrator;
        CHECK_AGREEMENT(agree(render_here(map, 1).film, render_here(grid, 2).film, integrator));
    }
}

TEST_CASE("a map that only multiplies equals a factor of the density", "[gpu][image][value_map][long]") {
    ValueMap twice;
    twice.points = {{0.0, 0.0}};
    twice.rise = 2.0;
    ValueMap by_points;
    by_points.points = {{0.0, 0.0}, {0.3, 0.6}, {1.5, 3.0}};
    Scene plain = lit_by_sun(mapped_cloud({}, 1.5));
    plain.volumes.front().density_scale = 2.0;
    const Film expected = render_here(plain, 2).film;
    for (const ValueMap& map : {twice, by_points})
        CHECK_AGREEMENT(agree(render_here(lit_by_sun(mapped_cloud(map, 1.5)), 1).film, expected, "factor"));
}

TEST_CASE("a transfer function of two values equals two boxes of what it says", "[gpu][image][value_map][long]") {
    GridRecipe halves{{0, 0, 0}, {7, 7, 7}, nullptr};
    halves.value = [](glm::ivec3 i) { return i.x < 4 ? 0.25f : 0.75f; };
    halves.linear = glm::dmat3(0.5);
    halves.translation = glm::dvec3(-1.75); // voxels, nearest to their middles, from -2 to 2
    ValueMap map;
    map.points = {{0.1, 0.0},
                  {0.1, 0.5, {0.9, 0.5, 0.2}, {0.3, 0.2, 0.1}},
                  {0.4, 0.5, {0.9, 0.5, 0.2}, {0.3, 0.2, 0.1}},
                  {0.6, 1.5, {0.2, 0.8, 0.9}, {0.0, 0.1, 0.4}}};
    map.is_transfer = true;
    Volume mapped = medium(write_grids({halves}), 1.0, 1.0, 0.3);
    mapped.map = map;
    Scene scene = lit_by_sun(mapped, 6.0);
    scene.settings.filter = Filter::nearest;
    scene.settings.integrator = "ratioTracking";
    const auto box = [](double x, const MapPoint& point) {
        Volume volume = medium(Box{{x, 0.0, 0.0}, {2.0, 4.0, 4.0}}, 1.0, 1.0, 0.3);
        volume.sigma_s = point.density * point.albedo;
        volume.sigma_a = point.density * (Rgb(1.0) - point.albedo);
        volume.Le = point.emission;
        return volume;
    };
    Scene boxes = scene;
    boxes.volumes = {box(-1.0, map.points[1]), box(1.0, map.points[3])};
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_here(boxes, 2).film, "two boxes"));
}

TEST_CASE("a transfer function equals a grid for each of its values", "[gpu][image][value_map][long]") {
    // Each with the density of the voxels of that value, and of the colours that the function gives them.
    const float values[] = {0.1f, 0.3f, 0.6f, 0.9f};
    const auto level = [](glm::ivec3 i) { return std::size_t(std::min(int(6.0f * cloud_noise(i)), 3)); };
    GridRecipe whole = cloud_grid();
    whole.value = [=](glm::ivec3 i) { return values[level(i)]; };
    Volume mapped = medium(write_grid(whole), 1.0, 1.0, 0.2);
    mapped.map = tissues();
    Scene by_map = lit_by_sun(mapped), by_grids = by_map;
    by_grids.volumes.clear();
    for (std::size_t k = 0; k < std::size(values); ++k) {
        const MapPoint point = reference::mapped(tissues(), values[k]);
        GridRecipe part = whole;
        part.value = [=](glm::ivec3 i) { return level(i) == k ? 1.0f : 0.0f; };
        Volume volume = medium(write_grid(part), 1.0, 1.0, 0.2);
        volume.sigma_s = point.density * point.albedo;
        volume.sigma_a = point.density * (Rgb(1.0) - point.albedo);
        volume.Le = point.emission;
        by_grids.volumes.push_back(volume);
    }
    by_map.settings.filter = by_grids.settings.filter = Filter::nearest;
    by_map.settings.integrator = by_grids.settings.integrator = "ratioTracking";
    CHECK_AGREEMENT(agree(render_here(by_map, 1).film, render_here(by_grids, 2).film, "a grid for each value"));
}

TEST_CASE("mapped media among several equal the reference, and their halves the whole", "[gpu][image][value_map]") {
    Scene scene = lit_by_sun(mapped_cloud(tissues()));
    Volume other = mapped_cloud(bumpy_map(), 0.8);
    other.g = -0.4;
    other.transform = glm::translate(glm::dmat4(1.0), glm::dvec3(0.8, -0.5, 0.4)) *
                      glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, 0.3)));
    scene.volumes.push_back(other);
    scene.volumes.push_back(medium(Sphere{{0.0, 1.0, 0.0}, 2.0}, 0.2, 0.5));
    check_against_reference(scene, "several");
    const Scene whole = lit_by_sun(mapped_cloud(tissues()));
    Scene halves = whole;
    halves.volumes.push_back(halves.volumes.front());
    halves.volumes[0].density_scale = 0.3;
    halves.volumes[1].density_scale = 0.7;
    CHECK_AGREEMENT(agree(render_here(whole, 1).film, render_here(halves, 2).film, "halves"));
}

TEST_CASE("what a map breaks gives way, in one line", "[cpu][method][value_map]") {
    Scene scene = lit_by_sun(mapped_cloud(bumpy_map()));
    scene.settings.integrator = "regularTracking";
    Method method = choose_method(scene);
    CHECK(method.free_flight == FREE_FLIGHT_DELTA);
    CHECK(method.transmittance == TRANSMITTANCE_RATIO);
    CHECK(method.filter == Filter::trilinear);
    REQUIRE(method.warnings.size() == 2);
    CHECK_THAT(method.warnings[0], Contains("flights are delta: where values are mapped"));
    CHECK_THAT(method.warnings[1], Contains("transmittance is by ratio tracking: where values are mapped"));
    scene.settings.filter = Filter::nearest;
    method = choose_method(scene);
    CHECK(method.free_flight == FREE_FLIGHT_REGULAR);
    CHECK(method.transmittance == TRANSMITTANCE_REGULAR);
    CHECK(method.warnings.empty());
    scene.settings.filter = Filter::stochastic;
    scene.settings.integrator = "ratioTracking";
    method = choose_method(scene);
    CHECK(method.filter == Filter::trilinear);
    REQUIRE(method.warnings.size() == 1);
    CHECK_THAT(method.warnings[0], Contains("a map of values would be biased by a stochastic one"));
}

TEST_CASE("maps in scene files", "[cpu][xml][value_map]") {
    const auto density = [](const ValueMap& map, double value) { return reference::mapped(map, value).density; };
    CHECK(!parse(field_to_map).volumes.front().map.exists());
    const ValueMap plain = ramp_of("");
    for (const double v : {0.0, 0.3, 7.0})
        CHECK(density(plain, v) == Approx(v));
    struct Ramp {
        double gain, offset, threshold;
    };
    for (const Ramp& r :
         {Ramp{2.0, -0.5, 0.0}, Ramp{2.0, -0.5, 0.4}, Ramp{2.0, 0.5, 0.4}, Ramp{-2.0, 1.5, 0.0}, Ramp{-2.0, 1.5, 0.4},
          Ramp{-2.0, 0.5, 0.4}, Ramp{0.0, 0.7, 0.4}, Ramp{1.0, 0.0, 0.4}, Ramp{-1.0, -1.0, 0.0}, Ramp{0.0, 0.0, 0.0}}) {
        const ValueMap map =
            ramp_of(fmt::format("gain='{}' offset='{}' threshold='{}'", r.gain, r.offset, r.threshold));
        for (double v = 0.013; v < 3.0; v += 0.041) { // none of them is a threshold or a root
            CAPTURE(r.gain, r.offset, r.threshold, v);
            CHECK(density(map, v) ==
                  Approx(v < r.threshold ? 0.0 : std::max(r.gain * v + r.offset, 0.0)).margin(1e-12));
        }
    }
    const Volume scan = parse(field_to_map + R"(<transferFunction unit="world"><point value="0" sigma_t="0"/>
        <point value=".5" sigma_t="2" albedo=".5"/><point value="1" sigma_t="3" albedo="1 .5 0" emission="0 0 4"/>
        </transferFunction>)")
                            .volumes.front();
    REQUIRE(scan.map.points.size() == 3);
    CHECK(scan.map.is_transfer);
    CHECK(scan.unit == CoefficientUnit::world);
    CHECK(scan.sigma_s == Rgb(1.0));
    CHECK(scan.sigma_a == Rgb(0.0));
    CHECK(scan.map.points[1].albedo == Rgb(0.5));
    CHECK(scan.map.points[2].albedo == Rgb(1.0, 0.5, 0.0));
    CHECK(scan.map.points[2].emission == Rgb(0.0, 0.0, 4.0));
    CHECK(scan.map.points[2].density == 3.0);
}

TEST_CASE("wrong maps in scene files are refused", "[cpu][xml][value_map]") {
    const auto points = [](const std::string& text) { return "<densityMap>" + text + "</densityMap>"; };
    std::string many;
    for (int i = 0; i < 257; ++i)
        many += fmt::format("<point value='{}' density='1'/>", i);
    const std::pair<std::string, const char*> bad[] = {
        {points("<point value='.3' density='1'/><point value='.2' density='1'/>"), "0.2 after 0.3; values ascend"},
        {points("<point value='1' density='1'/><point value='1' density='2'/><point value='1' density='3'/>"),
         "values ascend"},
        {points("<point value='1' density='-1'/>"), "a number >= 0"},
        {points("<point value='-100' density='1'/>"), "Hounsfield"},
        {points("<point value='1' density='nan'/>"), "not a number"},
        {points("<point value='inf' density='1'/>"), "not a number"},
        {points("<point value='1'/>"), "<point> lacks density"},
        {points("<point density='1'/>"), "<point> lacks value"},
        {points("<point value='1' sigma_t='1'/>"), "sigma_t"},
        {points("<point value='0' density='1e30'/><point value='1e-3' density='0'/>"), "changes too much"},
        {points(many), "more than 256 points"},
        {"<densityMap gain='1'><point value='1' density='1'/></densityMap>", "its points say all"},
        {"<densityMap gain='1e-30' offset='-1e30'/>", "ends beyond"},
        {"<densityMap/><transferFunction/>", "mapped once"},
        {"<transferFunction/>", "has no points"},
        {"<sigma_a>1</sigma_a><transferFunction><point value='1' sigma_t='1'/></transferFunction>",
         "<sigma_a> beside points that have sigma_t"},
        {"<transferFunction><point value='1' sigma_t='1' albedo='1.1'/></transferFunction>", "from 0 to 1"},
        {"<transferFunction><point value='1' sigma_t='1' albedo='1 1'/></transferFunction>",
         "2 numbers; expected one, or three"},
        {"<transferFunction><point value='1' sigma_t='1' emission='-1'/></transferFunction>", "from 0 to 1e12"},
        {"<transferFunction unit='metre'><point value='1' sigma_t='1'/></transferFunction>", "expected voxel or world"},
    };
    for (const auto& [text, message] : bad) {
        INFO(text);
        CHECK_THROWS_WITH(parse(field_to_map + text), Contains(message));
    }
    CHECK_THROWS_WITH(parse("<sphere/><densityMap/>"), Contains("maps the values of a <densityField>"));
}

TEST_CASE("maps in scene files are in the hash", "[cpu][xml][value_map]") {
    const auto hash = [](const std::string& text) { return scene_hash(parse(field_to_map + text)); };
    CHECK(hash("") != hash("<densityMap gain='2'/>"));
    CHECK(hash("<densityMap gain='2'/>") != hash("<densityMap gain='2.1'/>"));
    const std::string one = "<transferFunction><point value='1' sigma_t='1' albedo='.5'/></transferFunction>";
    const std::string two = "<transferFunction><point value='1' sigma_t='1' albedo='.6'/></transferFunction>";
    CHECK(hash(one) != hash(two));
}

TEST_CASE("a map that leaves nothing is warned of, and its picture is the background", "[gpu][value_map]") {
    ValueMap map;
    map.points = {{2.0, 0.0}, {3.0, 1.0}};
    Scene scene = lit_by_sun(mapped_cloud(map));
    scene.settings.spp = 1;
    const RenderResult result = render_here(scene, 1);
    for (const glm::vec3& pixel : result.film.mean)
        CHECK(pixel == glm::vec3(scene.background));
    const auto warnings = load_assets(scene, choose_method(scene)).media.front().warnings;
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings.front(), Contains("which <densityMap> maps to nothing"));
}
