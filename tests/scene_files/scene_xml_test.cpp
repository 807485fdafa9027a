// What scene files say, read.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <unistd.h>

#include "error.h"
#include "integrators.h"
#include "nearest_name.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/scene_text.h"
#include "test_paths.h"

using namespace vkvol;

namespace {

const std::filesystem::path scenes = std::filesystem::path(VKVOL_SOURCE_DIR) / "scenes";

const GridFile& grid_of(const Scene& scene) {
    return std::get<GridFile>(scene.volumes.at(0).shape);
}

// Every element of the vocabulary.
const char* const whole_vocabulary = R"(
        <densityField baseDir="..\fields\" grid="smoke">cloud.nvdb</densityField>
        <sigma_a unit="world"> 0.25 </sigma_a><sigma_s unit="world">4</sigma_s>
        <heyneygreenstein_g>-0.3</heyneygreenstein_g>
        <medium r="1" g=".5" b="0" multiplier="2"/>
        <light x="0" y="3" z="4" r="1" g="2" b="3" multiplier="10"/>
        <backgroundColor r="0.1" g="0.2" b="0.3" multiplier="2"/>
        <camera x="1" y="2" z="+3" pitch="-19" yaw="-8" roll="5" fov="60"/>
        <width startOffset="54" reference="216">108</width><height startOffset="27" reference="108">54</height>
        <rayPerPixelCount>64</rayPerPixelCount><maxDepth>3</maxDepth>
        <integrator scattering="single" flight="weighted" transmittance="march" nee="tentative"
                    emission="steps">ratioTracking</integrator>
        <march step="0.25" shadowStep="2" opticalStep="0.5" jitter="false" unit="world"/>
        <filter>trilinear</filter><russianRoulette threshold="0.05"/><majorant scale="1.5" cell="16"/>
        <lightRayDensityMultiplier>2.5</lightRayDensityMultiplier>
        <shadowRayDensityMultiplier>2.5</shadowRayDensityMultiplier>
        <multiThreaded freeThreads="1">true</multiThreaded><multiThreadedChunkSize>20</multiThreadedChunkSize>)";

} // namespace

TEST_CASE("above a folder is what lies there, behind a link to it too", "[cpu][xml]") {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("vkvol-linked-" + std::to_string(getpid()));
    fs::create_directories(folder / "real" / "scenes");
    std::ofstream(folder / "real" / "x.nvdb") << "x";
    fs::create_directory_symlink(folder / "real" / "scenes", folder / "link");
    const auto path_of = [&](const std::string& file) {
        return grid_of(parse_scene("<options><densityField>" + file + "</densityField></options>",
                                   folder / "link" / "s.xml"))
            .path;
    };
    CHECK(fs::exists(path_of("../x.nvdb")));
    CHECK(path_of("../none.nvdb") == folder / "none.nvdb");
    CHECK(path_of("a/../b.nvdb") == folder / "link" / "b.nvdb");
    fs::remove_all(folder);
}

TEST_CASE("an empty scene has the defaults of the documentation", "[cpu][xml]") {
    const Scene scene = parse("");
    CHECK(scene.volumes.empty());
    CHECK(scene.lights.empty());
    CHECK(scene.warnings.empty());
    CHECK(scene.settings.integrator.empty());
    CHECK_FALSE(scene.settings.max_depth);
    CHECK(scene.settings.spp == 1);
    CHECK(scene.picture.width == 400);
    CHECK(scene.picture.reference_height == 400.0);
    CHECK(scene.camera.fov == 90.0);
}

TEST_CASE("every element of the vocabulary is read", "[cpu][xml]") {
    const Scene scene = parse(whole_vocabulary);
    CHECK(scene.warnings.size() == 2); // steps of free flights, which this integrator does not take
    REQUIRE(scene.volumes.size() == 1);
    const Volume& volume = scene.volumes[0];
    CHECK(grid_of(scene).path == "../fields/cloud.nvdb");
    CHECK(grid_of(scene).grid == "smoke");
    CHECK(volume.sigma_a == Rgb(0.25));
    CHECK(volume.sigma_s == Rgb(4.0));
    CHECK(volume.unit == CoefficientUnit::world);
    CHECK(volume.g == -0.3);
    CHECK(volume.Le == Rgb(2, 1, 0));
    CHECK(volume.density_scale == 2.5);
    REQUIRE(scene.lights.size() == 1);
    const auto& light = std::get<DirectionalLight>(scene.lights[0]);
    CHECK(light.direction.y == Approx(0.6));
    CHECK(light.direction.z == Approx(0.8));
    CHECK(light.irradiance == Rgb(10, 20, 30));
    CHECK(scene.background.z == Approx(0.6));
    CHECK(scene.camera.position == glm::dvec3(1, 2, 3));
    CHECK(scene.camera.pitch == -19.0);
    CHECK(scene.camera.yaw == -8.0);
    CHECK(scene.camera.roll == 5.0);
    CHECK(scene.camera.fov == 60.0);
    CHECK(scene.picture.width == 108);
    CHECK(scene.picture.start_x == 54.0);
    CHECK(scene.picture.reference_width == 216.0);
    CHECK(scene.picture.height == 54);
    CHECK(scene.picture.start_y == 27.0);
    CHECK(scene.picture.reference_height == 108.0);
}

TEST_CASE("every setting of the vocabulary is read", "[cpu][xml]") {
    const Scene scene = parse(whole_vocabulary);
    CHECK(scene.settings.spp == 64);
    CHECK(scene.settings.max_depth.value() == 3);
    CHECK(parse("<maxDepth>0</maxDepth>").settings.max_depth.value() == 0);
    CHECK(scene.settings.integrator == "ratioTracking");
    const AxisChoices& choices = scene.settings.choices;
    CHECK(choices.scattering == SCATTERING_SINGLE);
    CHECK(choices.free_flight == FREE_FLIGHT_WEIGHTED);
    CHECK(choices.transmittance == TRANSMITTANCE_MARCH);
    CHECK(choices.nee == NEE_TENTATIVE);
    CHECK(choices.emission == EMISSION_AT_STEPS);
    const March& march = scene.settings.march;
    CHECK(march.step == 0.25);
    CHECK(march.shadow_step == 2.0);
    CHECK(march.optical_step == 0.5);
    CHECK_FALSE(march.jitter);
    CHECK(march.unit == CoefficientUnit::world);
    CHECK(scene.settings.filter == Filter::trilinear);
    CHECK(scene.settings.roulette_threshold == 0.05);
    CHECK(scene.settings.majorant_scale == 1.5);
    CHECK(scene.settings.majorant_cell == 16);
}

TEST_CASE("spheres and boxes hold homogeneous media", "[cpu][xml]") {
    const Scene ball = parse(R"(<sphere x="1" y="2" z="3" radius="4"/><sigma_a>1</sigma_a>)");
    CHECK(std::get<Sphere>(ball.volumes.at(0).shape).center == glm::dvec3(1, 2, 3));
    CHECK(std::get<Sphere>(ball.volumes.at(0).shape).radius == 4.0);
    CHECK(ball.volumes[0].unit == CoefficientUnit::world);
    CHECK(ball.warnings.empty());
    const Scene box = parse(R"(<box width="2" height="3" depth="4"/>)");
    CHECK(std::get<Box>(box.volumes.at(0).shape).size == glm::dvec3(2, 3, 4));
    CHECK(box.settings.march.unit == CoefficientUnit::world);
    CHECK_FALSE(box.volumes[0].noise);
}

TEST_CASE("models hold media", "[cpu][xml]") {
    const Scene scene = parse_scene(R"(<options><models><model baseDir="..\models\">ball.obj</model>
                                       <model>/data/cube.obj</model></models></options>)",
                                    "/scenes/a/s.xml");
    const std::vector<std::filesystem::path> paths = {"/scenes/models/ball.obj", "/data/cube.obj"};
    CHECK(std::get<MeshFiles>(scene.volumes.at(0).shape).paths == paths);
    CHECK(scene.volumes[0].unit == CoefficientUnit::world);
    CHECK(scene.warnings.empty());
    CHECK(parse("<models/>").volumes.empty());
    CHECK(error_of("<models>\n<model baseDir=\"x/\"/></models>") ==
          "s.xml:3:1: <model> names no file; write one between the tags, e.g. sphere.obj");
    CHECK_THAT(error_of("<models><modle>a.obj</modle></models>"), Catch::Contains("did you mean <model>?"));
}

TEST_CASE("between models and a density field the original's integrators decide", "[cpu][xml]") {
    const auto both = [](const std::string& integrator) {
        return parse("<models><model>a.obj</model></models><densityField>a.nvdb</densityField><integrator>" +
                     integrator + "</integrator>");
    };
    for (const char* name :
         {"densitySampling", "homogeneousRayMarcherNEE", "homogeneousRayMarcherImproved", "heterogeneousPerlinNoise"}) {
        CHECK(std::holds_alternative<MeshFiles>(both(name).volumes.at(0).shape));
        CHECK(warns(both(name), "<densityField> is left out"));
    }
    for (const char* name : {"", "nanoVDBSimple", "nanoVDBEmission", "deltaTracking", "ratioTracking"}) {
        CHECK(std::holds_alternative<GridFile>(both(name).volumes.at(0).shape));
        CHECK(warns(both(name), "<models> is left out"));
    }
    CHECK_THROWS_WITH(both("rayMarching"), Catch::Contains("a <models> beside the <densityField>"));
    CHECK_THAT(error_of("<sphere/><models><model>a.obj</model></models>"), Catch::Contains("one shape"));
}

TEST_CASE("the density of shapes can be noise", "[cpu][xml]") {
    const Scene scene = parse(R"(<box/><noise frequency="2" octaves="3" gain="0.25" lacunarity="4"/>)");
    const Noise& noise = scene.volumes.at(0).noise.value();
    CHECK(noise.frequency == 2.0);
    CHECK(noise.octaves == 3);
    CHECK(noise.gain == 0.25);
    CHECK(noise.lacunarity == 4.0);
    CHECK(parse("<models><model>a.obj</model></models><noise/>").volumes.at(0).noise->frequency == 1.8);
    CHECK_THAT(error_of("<densityField>a.nvdb</densityField>\n<noise/>"),
               Catch::StartsWith("s.xml:3:1: <noise> is for"));
    CHECK_THAT(error_of(R"(<box/><noise octaves="17"/>)"), Catch::Contains("<noise> octaves: "));
    CHECK_THAT(error_of(R"(<box/><noise frequency="0"/>)"), Catch::Contains("<noise> frequency: "));
    CHECK_THAT(error_of(R"(<box/><noise gain="1.5"/>)"), Catch::Contains("from 0 to 1"));
    CHECK_THAT(error_of(R"(<box/><noise lacunarity="0.5"/>)"), Catch::Contains("a number >= 1"));
}

TEST_CASE("coefficients are a number or one for each channel", "[cpu][xml]") {
    const Volume volume = parse(R"(<sphere/><sigma_a r="1" g="2" b="3"/><sigma_s>2</sigma_s>)").volumes.at(0);
    CHECK(volume.sigma_a == Rgb(1, 2, 3));
    CHECK(volume.sigma_s == Rgb(2, 2, 2));
    CHECK(error_of(R"(<sphere/><sigma_a r="1" b="3"/>)") == "s.xml:2:10: <sigma_a> lacks g; all of r, g, b are needed");
    CHECK_THAT(error_of(R"(<sphere/><sigma_s r="1" g="1" b="1">2</sigma_s>)"),
               Catch::StartsWith("s.xml:2:37: <sigma_s> has both a number and r, g, b"));
    CHECK_THAT(error_of(R"(<sphere/><sigma_s r="1" g="-1" b="1"/>)"), Catch::Contains("<sigma_s> g: '-1' is out of"));
}

TEST_CASE("an integrator's choices and the scene must fit", "[cpu][xml]") {
    CHECK(error_of(R"(<integrator flight="wieghted">ratioTracking</integrator>)") ==
          "s.xml:2:13: unknown flight 'wieghted'; did you mean weighted?");
    CHECK_THAT(error_of(R"(<integrator fligth="delta"/>)"), Catch::Contains("did you mean flight?"));
    CHECK_THAT(error_of("<densityField>a.nvdb</densityField>\n<integrator>densitySampling</integrator>"),
               Catch::StartsWith("s.xml:3:1: densitySampling: analytic flights need constant density"));
    CHECK_THAT(error_of("<box/><noise/>\n<integrator>regularTracking</integrator>"),
               Catch::StartsWith("s.xml:3:1: regularTracking: regular flights"));
    CHECK(error_of(R"(<march jitter="maybe"/>)") == "s.xml:2:8: <march> jitter: 'maybe' is neither true nor false");
    CHECK_THAT(error_of(R"(<march unit="metre"/>)"), Catch::Contains("voxel or world"));
    CHECK_THAT(error_of(R"(<march step="0"/>)"), Catch::Contains("<march> step: "));
}

TEST_CASE("the report's own scenes load unmodified", "[cpu][xml]") {
    const std::map<std::string, double> g = {{"bunny-deltaTracking", 0.2},
                                             {"explosion-deltaTracking", 0.8},
                                             {"bunny-ratioTracking", 0.8},
                                             {"explosion-ratioTracking", 0.8}};
    for (const auto& [name, expected] : g) {
        INFO(name);
        const Scene scene = load_scene(scenes / "thesis" / (name + ".xml"));
        REQUIRE(scene.volumes.size() == 1);
        CHECK(scene.volumes[0].g == expected);
        CHECK(grid_of(scene).path.string().find('\\') == std::string::npos);
        CHECK(grid_of(scene).path.parent_path() == (scenes / "DensityFields").lexically_normal());
        CHECK(scene.settings.max_depth.value() == 16);
        CHECK(scene.picture.height == 1080);
        CHECK(scene.lights.size() == (name.find("ratio") != std::string::npos ? 1 : 0));
        CHECK(scene.warnings.size() == 1); // stepSize
        CHECK(warns(scene, "stepSize"));
    }
}

TEST_CASE("$keys are filled in", "[cpu][xml]") {
    const Scene scene =
        parse(R"(<sphere radius="${r}"/><sigma_s>$s</sigma_s><camera x="1${r}5"/>)", {{"r", "2"}, {"s", "0.5"}});
    CHECK(std::get<Sphere>(scene.volumes.at(0).shape).radius == 2.0);
    CHECK(scene.volumes[0].sigma_s == Rgb(0.5));
    CHECK(scene.camera.position.x == 125.0);
    CHECK(grid_of(parse("<densityField>a$$b.nvdb</densityField>")).path == "a$b.nvdb");
    CHECK(error_of("<sigma_s> $s</sigma_s>") ==
          "s.xml:2:11: $s has no value; give it with -D s=VALUE, or here with a default: ${s:-VALUE}");
    CHECK(error_of(R"(<camera x="$x"/>)") ==
          "s.xml:2:9: $x has no value; give it with -D x=VALUE, or here with a default: ${x:-VALUE}");
    CHECK_THAT(error_of(R"(<camera x="${x"/>)", {{"x", "1"}}), Catch::Contains("${x: expected }"));
    CHECK_THAT(error_of(R"(<camera x="$"/>)"), Catch::Contains("names no key"));
    CHECK(error_of(R"(<camera x="$size"/>)", {{"size", "1"}, {"sise", "2"}}) ==
          "s.xml: -D sise=2 is used nowhere in the scene; did you mean size?");
    CHECK_THAT(error_of("", {{"k", "2"}}), Catch::Contains("the scene has no $keys"));
    CHECK_THAT(error_of("<sigma_s>$s</sigma_s>", {{"s", "-1"}}), Catch::StartsWith("s.xml:2:10: <sigma_s> '-1'"));
    CHECK_THAT(error_of("<sigma_s>$s</sigma_s>", {{"s", "<a/>"}}), Catch::Contains("not a number"));
}

TEST_CASE("paths start from the scene file", "[cpu][xml]") {
    const auto path = [](const std::string& element) {
        return grid_of(parse_scene("<options>" + element + "</options>", "/scenes/a/s.xml")).path.string();
    };
    CHECK(path("<densityField>f.nvdb</densityField>") == "/scenes/a/f.nvdb");
    CHECK(path("<densityField baseDir=\"..\\fields\\\">x\\f.nvdb</densityField>") == "/scenes/fields/x/f.nvdb");
    CHECK(path("<densityField baseDir=\"fields\">f.nvdb</densityField>") == "/scenes/a/fields/f.nvdb");
    CHECK(path("<densityField baseDir=\"/data/\">f.nvdb</densityField>") == "/data/f.nvdb");
}

TEST_CASE("the command line's grid and integrator replace the scene's", "[cpu][xml]") {
    SceneOverrides overrides;
    overrides.grid = "other.vdb";
    const Scene grid = parse("<densityField grid=\"d\">a.nvdb</densityField><sigma_s>3</sigma_s>", {}, overrides);
    CHECK(grid_of(grid).path == "other.vdb");
    CHECK(grid_of(grid).grid == "d");
    CHECK(grid.volumes[0].sigma_s == Rgb(3.0));
    CHECK(grid_of(parse("<sphere/>", {}, overrides)).grid == "density");
    CHECK(warns(parse("<sphere/>", {}, overrides), "<sphere> is left out"));
    CHECK(grid.warnings.empty());
    CHECK(grid_of(parse("", {}, overrides)).path == "other.vdb");
    const Scene drifting = parse("<densityField grid='d' velocity='v'/><motionBlur/>", {}, overrides);
    CHECK(grid_of(drifting).grid == "d");
    CHECK(drifting.volumes.at(0).drift.grid == "v");
    CHECK_THAT(error_of("<densityField grid='d'/>"), Catch::Contains("names no file"));
    CHECK(warns(parse("<sphere/><noise/>", {}, overrides), "<noise> is left out"));
    CHECK_FALSE(parse("<sphere/><noise/>", {}, overrides).volumes.at(0).noise);
    overrides = {};
    overrides.integrator = "deltaTracking:nee=tentative";
    CHECK(parse("<integrator flight=\"weighted\">nanoVDBSimple</integrator>", {}, overrides).settings.choices.nee ==
          NEE_TENTATIVE);
    CHECK_FALSE(parse("<integrator flight=\"weighted\"/>", {}, overrides).settings.choices.free_flight);
    overrides.integrator = "densitySampling";
    CHECK_THROWS_WITH(parse("<densityField>a.nvdb</densityField><integrator/>", {}, overrides),
                      Catch::StartsWith("s.xml: densitySampling: "));
    overrides.integrator = "ratioTracking";
    const Scene scene = parse("<integrator>nanoVDBSimple</integrator><sphere/><light y=\"1\" r=\"1\"/>", {}, overrides);
    CHECK(scene.settings.integrator == "ratioTracking");
    CHECK(scene.warnings.empty());
}

TEST_CASE("a resized picture keeps its view", "[cpu][xml]") {
    Picture picture{1080, 540, 540, 270, 2160, 1080};
    resize_picture(picture, 270, std::nullopt);
    CHECK(picture.width == 270);
    CHECK(picture.height == 135);
    CHECK(picture.start_x == 135.0);
    CHECK(picture.reference_width == 540.0);
    CHECK(picture.start_y == 67.5);
    CHECK(picture.reference_height == 270.0);
    resize_picture(picture, 100, 100);
    CHECK(picture.width == 100);
    CHECK(picture.height == 100);
    CHECK(picture.start_x / picture.reference_width == Approx(0.25));
    CHECK_THROWS_AS(resize_picture(picture, 0, std::nullopt), InputError);
    CHECK_THROWS_AS(resize_picture(picture, std::nullopt, 70000), InputError);
}

TEST_CASE("nearest names", "[cpu][xml]") {
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("ab", "ba") == 1);
    CHECK(nearest_name("hight", {"width", "height"}) == "height");
    CHECK(nearest_name("xyz", {"width", "height"}).empty());
    CHECK(nearest_name("r", {"x", "y", "radius"}) == "radius");
    CHECK(nearest_name("q", {"x", "y", "radius"}).empty());
}

TEST_CASE("the scene hash follows what the picture depends on", "[cpu][xml]") {
    const std::string hash = scene_hash(parse("<sphere/>"));
    CHECK(hash.size() == 16);
    CHECK(scene_hash(parse("<sphere/><rayPerPixelCount>9</rayPerPixelCount><filter>trilinear</filter>")) == hash);
    for (const char* change :
         {"<noise/>", "<integrator scattering=\"single\"/>", "<sigma_a r=\".5\" g=\".5\" b=\".6\"/>",
          "<sigma_a>1</sigma_a>", "<maxDepth>3</maxDepth>", "<camera x=\"1\"/>", "<width>401</width>",
          "<heyneygreenstein_g>.1</heyneygreenstein_g>", "<filter>nearest</filter>", "<light y=\"1\" r=\"1\"/>",
          "<backgroundColor r=\"1\"/>", "<medium r=\"1\"/>"})
        CHECK(scene_hash(parse(std::string("<sphere/>") + change)) != hash);
    CHECK(scene_hash(parse("<box/>")) != hash);
    CHECK(scene_hash(parse_scene("<options><densityField>f.nvdb</densityField></options>", "/a/s.xml")) ==
          scene_hash(parse_scene("<options><densityField>f.nvdb</densityField></options>", "/b/s.xml")));
}

TEST_CASE("the scene hash follows the camera, the filter of pixels and the grid of albedos", "[cpu][xml]") {
    const auto hash = [](const std::string& elements) {
        return scene_hash(parse("<densityField>f.nvdb</densityField>" + elements));
    };
    std::set<std::string> hashes = {hash("")};
    const char* const different[] = {
        R"(<camera projection="orthographic"/>)",
        R"(<camera projection="orthographic" viewHeight="3"/>)",
        R"(<camera projection="equirectangular"/>)",
        R"(<camera lensRadius=".5" focus="3"/>)",
        R"(<camera lensRadius=".6" focus="3"/>)",
        R"(<camera lensRadius=".5" focus="4"/>)",
        R"(<camera lensRadius=".5" focus="3" blades="5"/>)",
        R"(<camera lensRadius=".5" focus="3" blades="5" bladeRotation="7"/>)",
        R"(<pixelFilter radius="1">box</pixelFilter>)",
        "<pixelFilter>tent</pixelFilter>",
        R"(<pixelFilter radius="2">tent</pixelFilter>)",
        R"(<albedo grid="Cd"/>)",
        R"(<albedo grid="Cs"/>)",
    };
    for (const char* elements : different) {
        CAPTURE(elements);
        CHECK(hashes.insert(hash(elements)).second);
    }
    CHECK(hash("<pixelFilter>box</pixelFilter>") == hash(""));
    CHECK(hash(R"(<camera projection="perspective" lensRadius="0"/>)") == hash(""));
    CHECK(hash(R"(<camera lensRadius=".5" focus="3" bladeRotation="7"/>)") ==
          hash(R"(<camera lensRadius=".5" focus="3"/>)")); // a round one
}

TEST_CASE("the schema knows every integrator", "[cpu][xml]") {
    std::ifstream stream(scenes / "vkvol.xsd");
    const std::string schema((std::istreambuf_iterator<char>(stream)), {});
    for (const std::string& name : integrator_names())
        CHECK_THAT(schema, Catch::Contains("\"" + name + "\""));
    for (const Axis& axis : axes()) {
        CHECK_THAT(schema, Catch::Contains("<xs:attribute name=\"" + std::string(axis.name) + "\""));
        for (const std::string& name : axis.names)
            CHECK_THAT(schema, Catch::Contains("\"" + name + "\""));
    }
}

TEST_CASE("what a picture is expected to show", "[cpu][xml]") {
    CHECK_FALSE(parse_scene("<options/>", "s.xml").expected);
    const auto read = [](const std::string& attributes) {
        return *parse_scene("<options>\n<expected " + attributes + "/></options>", "s.xml").expected;
    };
    const Expected three = read(R"(mean=" 0.5  1 1.5" bias="1e-3" exact="true")");
    CHECK(three.mean == Rgb(0.5, 1.0, 1.5));
    CHECK(three.bias == Rgb(1e-3));
    CHECK(three.exact);
    const Expected one = read(R"(mean="2")");
    CHECK(one.mean == Rgb(2.0));
    CHECK(one.bias == Rgb(0.0));
    CHECK_FALSE(one.exact);
    for (const auto& [attributes, message] : std::vector<std::pair<std::string, std::string>>{
             {"", "s.xml:2:1: <expected> lacks mean"},
             {R"(mean="1 2")", "2 numbers; expected one, or three"},
             {R"(mean="")", "0 numbers"},
             {R"(mean="1 x 2")", "'x' is not a number"},
             {R"(mean="-1")", "out of range"},
             {R"(mean="1" bias="nan")", "bias"},
             {R"(mean="1" exact="perhaps")", "neither true nor false"},
             {R"(mean="1" tolerance="2")", "unknown attribute 'tolerance'"}}) {
        INFO(attributes);
        CHECK_THROWS_WITH(read(attributes), Catch::Contains(message));
    }
}

TEST_CASE("layers are left out where the density is that of --grid", "[cpu][xml]") {
    SceneOverrides overrides;
    overrides.grid = "other.nvdb";
    const Scene scene = parse("<box/><layers scaleHeight='1'/>", {}, overrides);
    CHECK_FALSE(scene.volumes.at(0).layers);
    CHECK(warns(scene, "<layers> are left out"));
}

TEST_CASE("digits of a frame are of whole numbers", "[cpu][xml]") {
    CHECK_THROWS_WITH(parse("<densityField>smoke.$F4.nvdb</densityField>", {{"F", "2.5"}}),
                      Catch::Contains("F is 2.5") && Catch::Contains("${F}"));
}
