// Emission that follows a temperature grid: the black body's colour, and whole pictures against the reference.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "blackbody.h"
#include "method.h"
#include "scene_xml.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_meshes.h"
#include "tests/reference/emission.h"

using namespace vkvol;

TEST_CASE("black bodies have the reference's colours", "[cpu][emission]") {
    // Both sum over wavelengths, every 2 nm here and every 0.5 nm there, at other points: the sums of so smooth an
    // integrand differ by its curvature at the ends of the visible, a part in 10^4 at most.
    for (const double kelvin : {300.0, 1000.0, 1500.0, 2200.0, 3000.0, 6504.0, 20000.0, 40000.0, 1e6}) {
        const Rgb ours = blackbody_rgb(kelvin, 1500.0), theirs = reference::blackbody(kelvin, 1500.0);
        INFO(kelvin << " K: " << ours.x << " " << ours.y << " " << ours.z);
        for (int c = 0; c < 3; ++c)
            CHECK(ours[c] == Approx(theirs[c]).epsilon(1e-3).margin(1e-6 * theirs.x));
    }
}

TEST_CASE("black bodies at the edges", "[cpu][emission]") {
    const auto luminance = [](Rgb c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; };
    // Also where blue and green are clipped.
    for (const double kelvin : {500.0, 800.0, 1500.0, 6504.0})
        CHECK(luminance(blackbody_rgb(kelvin, kelvin)) == Approx(1.0).epsilon(1e-3));
    for (const double kelvin : {-5.0, 0.0, 1e-3, 1.0, 20.0}) // exp overflows: nothing, not NaN
        CHECK(blackbody_rgb(kelvin, 1500.0) == Rgb(0.0));
    for (double kelvin = 800.0; kelvin < 6000.0; kelvin += 100.0) { // red, orange, yellow: never another order
        const Rgb c = blackbody_rgb(kelvin, 1500.0), warmer = blackbody_rgb(kelvin + 100.0, 1500.0);
        CHECK(c.x >= c.y);
        CHECK(c.y >= c.z);
        CHECK(warmer.x > c.x);
        CHECK((warmer.y / warmer.x > c.y / c.x || (c.y == 0.0 && kelvin < 1000.0))); // beyond Rec.709's reds
    }
}

TEST_CASE("beside what is too cold to be seen any glow is endless", "[cpu][emission]") {
    CHECK(std::isinf(blackbody_rgb(2000.0, 1.0).x)); // which is refused where a scene asks for it, and no black picture
    CHECK(blackbody_rgb(2.0, 1.0) == Rgb(0.0));
    CHECK(blackbody_rgb(2.0, 0.0) == Rgb(0.0));
}

TEST_CASE("the black-body table is as exact as it says", "[cpu][emission]") {
    const int count = 4096;
    const double low = 0.0, high = 3000.0, step = (high - low) / (count - 1);
    const std::vector<glm::vec4> table = make_blackbody_table(low, high, 1500.0, count);
    for (int i = 1000; i + 1 < count; i += 7) {
        const double kelvin = low + (i + 0.5) * step;
        const double exact = blackbody_rgb(kelvin, 1500.0).x;
        // The bound of blackbody.h, and the rounding of table entries to single precision.
        const double bound = std::pow(1.44e7 / 400.0 / (kelvin * kelvin) * step, 2) / 8.0 + 1.2e-7;
        CHECK(std::abs((double(table[i].x) + double(table[i + 1].x)) / 2.0 / exact - 1.0) <= bound);
    }
}

namespace {

// The cloud, with a temperature grid of another voxel size, rotated against it, and smaller: parts stay cold.
GridFile burning_cloud(Storage storage) {
    GridRecipe heat;
    heat.first = {-6, -5, -4};
    heat.last = {9, 8, 7};
    heat.value = [](glm::ivec3 i) { return 0.6f + 1.8f * cloud_noise(i * 3 + 40); };
    heat.storage = storage;
    heat.name = "temperature";
    const double c = std::cos(0.4), s = std::sin(0.4);
    heat.linear = 0.45 * glm::dmat3(c, s, 0, -s, c, 0, 0, 0, 1);
    heat.translation = {0.2, -0.3, 0.1};
    return write_grids({cloud_grid(), heat});
}

Scene fire(TemperatureEmission emission, Storage storage = Storage::float32) {
    Volume volume = medium(burning_cloud(storage), 2.0, 0.5, 0.2);
    volume.temperature = emission;
    volume.Le = {0.02, 0.03, 0.05};
    Scene scene = scene_of(volume, 11.0, 24, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 192;
    return scene;
}

TemperatureEmission glow_by(TemperatureEmission::Model model) {
    TemperatureEmission emission;
    emission.model = model;
    emission.color = {1.0, 0.8, 0.5};
    if (model == TemperatureEmission::Model::blackbody) {
        emission.scale = 600.0;
        emission.offset = 300.0;
        emission.cutoff = 800.0;
    }
    return emission;
}

} // namespace

TEST_CASE("fire equals the reference", "[gpu][image][emission]") {
    for (const auto model : {TemperatureEmission::Model::color, TemperatureEmission::Model::blackbody}) {
        const Scene scene = fire(glow_by(model));
        CHECK_AGREEMENT(
            agree(render_here(scene, 1).film, render_reference(scene, 2), fmt::format("fire {}", int(model))));
    }
    const Scene quantised = fire(glow_by(TemperatureEmission::Model::blackbody), Storage::fp8);
    CHECK_AGREEMENT(agree(render_here(quantised, 1).film, render_reference(quantised, 2), "fire, Fp8 temperatures"));
}

TEST_CASE("an opaque fire without scattering has its own radiance", "[gpu][emission]") {
    // A ray through the middle meets an extinction of 100 per unit over 4 units: the background gets exp(-400), and
    // Le is the same 2 * color everywhere, so each sample is that value, up to the rounding of three products.
    GridRecipe density{{0, 0, 0},       {19, 19, 19}, [](glm::ivec3) { return 1.0f; }, {}, 0.0f,
                       glm::dmat3(0.2), {-2, -2, -2}};
    GridRecipe heat = density;
    heat.first = glm::ivec3(-4);
    heat.last = glm::ivec3(24);
    heat.value = [](glm::ivec3) { return 2.0f; };
    heat.name = "temperature";
    Volume volume = medium(write_grids({density, heat}), 100.0, 0.0);
    volume.temperature.color = {3.0, 2.0, 1.0};
    Scene scene = scene_of(volume, 2.0, 8);
    scene.background = Rgb(9.0);
    scene.settings.spp = 4;
    for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
        for (int c = 0; c < 3; ++c)
            CHECK(pixel[c] == Approx(2.0 * volume.temperature.color[c]).epsilon(4 * 6e-8));
}

TEST_CASE("particles of what glows know grids of any unit", "[gpu][emission][particles]") {
    const auto picture = [](double unit, const char* integrator, std::uint32_t seed) {
        GridRecipe density{{0, 0, 0},       {9, 9, 9},   [](glm::ivec3) { return 1.0f; }, {}, 0.0f,
                           glm::dmat3(0.2), {-1, -1, -1}};
        GridRecipe heat = density;
        heat.value = [unit](glm::ivec3 i) { return float(unit * (0.5 + 0.1 * i.x)); };
        heat.name = "temperature";
        Volume volume = medium(write_grids({density, heat}), 0.5, 0.5);
        volume.temperature.color = Rgb(3.0, 2.0, 1.0) / unit;
        Scene scene = scene_of(volume, 3.0, 8);
        scene.settings.spp = 1024;
        scene.settings.integrator = integrator;
        return render_here(scene, seed).film;
    };
    const Film expected = picture(1.0, "deltaTracking", 1);
    for (const double unit : {1e-20, 1.0, 1e12})
        CHECK_AGREEMENT(agree(picture(unit, "lightTracing", 2), expected, fmt::format("in units of {}", unit)));
}

TEST_CASE("a file without a temperature grid does not glow, and says so", "[gpu][emission]") {
    Scene scene = scene_of(medium(write_grid(cloud_grid()), 2.0, 0.5), 11.0, 8);
    scene.volumes.front().temperature.color = Rgb(1.0);
    const RenderResult result = render_here(scene, 1);
    REQUIRE(result.warnings.size() == 1);
    CHECK_THAT(result.warnings.front(), Catch::Contains("no grid \"temperature\""));
    CHECK(mean_of(result.film) == 0.0);
}

TEST_CASE("a temperature grid that is cold throughout does not glow, and says so", "[gpu][emission]") {
    const float warmth = GENERATE(0.0f, -1.0f);
    GridRecipe heat = cloud_grid();
    heat.value = [warmth](glm::ivec3) { return warmth; };
    heat.name = "temperature";
    Scene scene = scene_of(medium(write_grids({cloud_grid(), heat}), 2.0, 0.5), 11.0, 8);
    scene.volumes.front().temperature.color = Rgb(1.0);
    const RenderResult result = render_here(scene, 1);
    CHECK(std::any_of(result.warnings.begin(), result.warnings.end(),
                      [](const std::string& warning) { return warning.find("no value above 0") != warning.npos; }));
    CHECK(mean_of(result.film) == 0.0);
}

TEST_CASE("emission in scene files", "[cpu][emission]") {
    const Scene scene = parse_scene(R"(<options><densityField baseDir="">f.nvdb</densityField>
        <emission r="1" g=".5" multiplier="2" model="blackbody" grid="heat" temperatureScale="600"
                  temperatureOffset="300" temperatureCutoff="900" referenceTemperature="2000"/></options>)",
                                    "s.xml");
    const TemperatureEmission& e = scene.volumes.front().temperature;
    CHECK(e.model == TemperatureEmission::Model::blackbody);
    CHECK(e.color == Rgb(2.0, 1.0, 0.0));
    CHECK(e.grid == "heat");
    CHECK(glm::dvec4(e.scale, e.offset, e.cutoff, e.reference) == glm::dvec4(600, 300, 900, 2000));
    const auto parse = [](const char* element) {
        return parse_scene(std::string("<options><sphere/>\n") + element + "</options>", "s.xml");
    };
    CHECK_THROWS_WITH(parse(R"(<emission model="pink"/>)"),
                      Catch::Contains("s.xml:2:") && Catch::Contains("blackbody"));
    CHECK_THROWS_WITH(parse(R"(<emission temperatureScale="2"/>)"), Catch::Contains("blackbody\" only"));
    CHECK_THROWS_WITH(parse(R"(<emission model="blackbody" referenceTemperature="0"/>)"), Catch::Contains("> 0"));
    CHECK_THROWS_WITH(parse(R"(<emission model="blackbody" brightness="peak" referenceTemperature="2000"/>)"),
                      Catch::Contains("brightness=\"planck\" only"));
    CHECK_THROWS_WITH(parse(R"(<emission model="blackbody" brightness="bright"/>)"), Catch::Contains("planck or peak"));
}

TEST_CASE("an even glow along flights that are closed forms equals that at collisions", "[gpu][image][emission]") {
    const std::string matter = "<sigma_a r='0.5' g='0.2' b='1'/><sigma_s r='1' g='0.3' b='0.1'/><medium r='1' g='0.7' "
                               "b='0.4'/><width>12</width><height>12</height><rayPerPixelCount>400</rayPerPixelCount>";
    const std::string lamp = "<lights><point x='1.5' y='1' z='1' power='20'/></lights>";
    const std::string floor = "<surfaces><plane y='-1.2' r='0.6' g='0.5' b='0.3'/></surfaces>";
    const std::vector<std::string> scenes = {
        "<sphere/><camera z='5' fov='30'/>" + lamp,
        "<box width='2' height='1' depth='2'/><camera x='1' y='1' z='5' lookAt='0 0 0' fov='30'/>" + floor + lamp,
        "<everywhere/><layers scaleHeight='2' bottom='-1' top='9'/><camera y='1' z='5' pitch='10' fov='50'/>",
        "<box width='2' height='2' depth='2'/><periodic x='-1.5 1.5'/><maxDepth>9</maxDepth><camera z='5' y='3' "
        "lookAt='0 0 0' fov='50'/>"};
    std::vector<Scene> all;
    for (const std::string& xml : scenes)
        all.push_back(parse(xml + matter));
    // Two bodies in a row: what glows in the one behind has lost the colours of the other.
    const Mesh bodies =
        join(make_box({-0.5, -0.5, -2.5}, {0.5, 0.5, -1.5}, 1), make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 1));
    all.push_back(parse("<sphere/><camera z='4' fov='10'/>" + matter));
    all.back().volumes.front().shape = write_mesh(bodies);
    for (Scene& scene : all) {
        scene.settings.integrator = "ratioTracking";
        scene.settings.choices.emission = EMISSION_AT_STEPS;
        REQUIRE(choose_method(scene).emission_at == EMISSION_AT_STEPS);
        const Film along = render_here(scene, 1).film;
        scene.settings.choices.emission = EMISSION_AT_COLLISIONS;
        CHECK_AGREEMENT(agree(along, render_here(scene, 2).film, "even glow"));
    }
}
