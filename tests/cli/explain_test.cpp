// A picture that shows nothing explains itself: each cause in a scene that is fine but for that, and none where a
// picture is one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "error.h"
#include "explain.h"
#include "support/command_folder.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

struct Found {
    std::string picture, cause, text; // empty: no explanation
};

Found found(const std::optional<Explanation>& explanation) {
    return explanation ? Found{explanation->picture, explanation->cause, explanation->text} : Found{};
}

// As the command does.
Found explanation_of(const Scene& scene, const ToneRequest& request = {}, Crop crop = {}) {
    if (const std::optional<Explanation> foreseen = foresee(scene))
        return found(foreseen);
    RenderJob job;
    job.disk_cache = false;
    job.crop = crop.x1 > 0 ? crop : Crop{0, scene.picture.width, 0, scene.picture.height};
    const RenderResult result = render(test_device(), scene, job);
    Metadata metadata;
    record_tone(request, result.glows, metadata);
    return found(explain(scene, result, choose_tone(request, result.film, metadata)));
}

Found explanation_of(const std::string& body, const SceneOverrides& overrides = {}) {
    return explanation_of(parse(body, {}, overrides));
}

std::string with(std::string body, const std::string& from, const std::string& to) {
    const std::size_t at = body.find(from);
    if (at == std::string::npos)
        throw std::logic_error("no " + from + " in " + body);
    return body.replace(at, from.size(), to);
}

const std::string picture = "<width>24</width><height>24</height><rayPerPixelCount>4</rayPerPixelCount>";

const std::string lit_ball = "<sphere/><sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>"
                             "<light x=\"1\" y=\"1\" z=\"1\" r=\"5\" g=\"5\" b=\"5\"/>"
                             "<camera z=\"5\" fov=\"30\"/>" +
                             picture;

// Before a sky; it fills the picture.
const std::string slab_text = "<box width=\"20\" height=\"20\" depth=\"1\"/><sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>"
                              "<backgroundColor r=\"0.5\" g=\"0.5\" b=\"0.5\"/><camera z=\"5\" fov=\"30\"/>" +
                              picture;

const std::string ball_before_sky = with(slab_text, "<box width=\"20\" height=\"20\" depth=\"1\"/>", "<sphere/>");

struct Row {
    std::string good, from, to; // what spoils it
    const char* picture;
    const char* cause;
    const char* words;
};

void check(const Row& row) {
    CAPTURE(row.from, row.to, row.cause);
    CHECK(explanation_of(row.good).cause == "");
    const Found bad = explanation_of(with(row.good, row.from, row.to));
    CHECK(bad.picture == row.picture);
    CHECK(bad.cause == row.cause);
    CHECK_THAT(bad.text, Contains(row.words));
    CHECK(bad.text.find('\n') == std::string::npos);
}

const std::string light = "<light x=\"1\" y=\"1\" z=\"1\" r=\"5\" g=\"5\" b=\"5\"/>";
const std::string sigma_s = "<sigma_s>2</sigma_s>";
const std::string camera = "<camera z=\"5\" fov=\"30\"/>";

} // namespace

TEST_CASE("a room that no light enters is explained", "[gpu][explain]") {
    const Found room = explanation_of("<surfaces><box width=\"12\" height=\"12\" depth=\"12\"/></surfaces>" + light +
                                      camera + picture);
    CHECK(room.picture == "black");
    CHECK(room.cause == "shadowed");
    CHECK(explanation_of("<surfaces><plane y=\"-1\"/></surfaces>" + light + camera + picture).cause == "");
}

TEST_CASE("pictures without light are explained", "[gpu][explain]") {
    check({lit_ball, light, "", "black", "noLight", "the scene has no <light>"});
    check({lit_ball, "r=\"5\" g=\"5\" b=\"5\"", "multiplier=\"5\"", "black", "blackSource", "<light> at "});
    check({lit_ball, light, "<backgroundColor multiplier=\"2\"/>", "black", "blackSource", "<backgroundColor> at "});
    check({lit_ball, light, "<medium multiplier=\"2\"/>", "black", "blackSource", "<medium> at "});
    check({lit_ball, sigma_s, "<sigma_s>0</sigma_s>", "black", "lightUnseen", "sigma_s is 0"});
    check({lit_ball, light, light + "<maxDepth>0</maxDepth>", "black", "lightUnseen", "maxDepth is 0"});
    check({lit_ball, light, light + "<integrator>deltaTracking</integrator>", "black", "lightUnseen",
           "no path of deltaTracking meets by chance; use --integrator ratioTracking"});
    check({lit_ball, light, light + "<integrator>densitySampling</integrator>", "black", "lightUnseen",
           "densitySampling scatters nothing"});
    const std::string glowing = with(lit_ball, light, "<medium r=\"1\" g=\"0.5\" b=\"0.1\"/>");
    check({glowing, "<sigma_a>0.5</sigma_a>", "<sigma_a>0</sigma_a>", "black", "noGlow", "raise sigma_a"});
    check({lit_ball, "r=\"5\" g=\"5\" b=\"5\"", "r=\"1e-6\" g=\"1e-6\" b=\"1e-6\"", "black", "dim", "--exposure "});
}

TEST_CASE("lights that are not seen are called by their names", "[gpu][explain]") {
    const std::string point = "<lights><point x=\"2\" multiplier=\"9\"/></lights>";
    check({with(lit_ball, light, point), sigma_s, "<sigma_s>0</sigma_s>", "black", "lightUnseen",
           "<point> is seen by what the medium scatters of it alone, and sigma_s is 0"});
    const std::string lamps = "<lights><point x=\"2\" multiplier=\"9\"/><sphere y=\"6\" multiplier=\"9\"/></lights>";
    check({with(lit_ball, light, lamps), lamps, lamps + "<integrator>deltaTracking</integrator>", "black",
           "lightUnseen", "nothing gives light but <point>, <sphere>, which no path of deltaTracking meets by chance"});
}

TEST_CASE("pictures that miss the medium are explained", "[gpu][explain]") {
    check({lit_ball, camera, "<camera z=\"5\" yaw=\"180\" fov=\"30\"/>", "black", "missed",
           "is behind the camera: the camera at (0, 0, 5) looks along ("});
    check(
        {lit_ball, camera, "<camera z=\"5\" yaw=\"40\" fov=\"30\"/>", "black", "missed", "40 degrees off the middle"});
    check({ball_before_sky, camera, "<camera z=\"-5\" fov=\"30\"/>", "background", "missed",
           "(-1, -1, -1) to (1, 1, 1)"});
    check({ball_before_sky, camera, "<camera z=\"-5\" fov=\"30\"/>", "background", "missed", "--frame"});
    check({ball_before_sky, "<width>24</width>", "<width reference=\"240\" startOffset=\"0\">24</width>", "background",
           "missed", "startOffset"});
    check({lit_ball, camera, "<camera z=\"5000\" fov=\"30\"/>", "black", "speck", "pixels in a picture of 24x24"});
    check({lit_ball, camera, "<camera z=\"5\" x=\"9\" projection=\"orthographic\"/>", "black", "missed",
           "with a view 10 high; --frame frames it, or look at (0, 0, 0)"});
    check({lit_ball, camera, "<camera z=\"5\" projection=\"orthographic\" viewHeight=\"3000\"/>", "black", "speck",
           "lower viewHeight, or --frame it"});
    check({lit_ball, camera, "<camera z=\"5000\" projection=\"equirectangular\"/>", "black", "speck",
           "24x24; go nearer"});
    check({lit_ball, camera + "<width>24</width>",
           "<camera z=\"5\" projection=\"equirectangular\"/><width reference=\"240\">24</width>", "black", "missed",
           "startOffset"});
    check({lit_ball, "<sphere/>", "<box width=\"1e-3\" height=\"2\" depth=\"1\"/>", "black", "missed",
           "too thin to be met by any"});
    check({lit_ball, "<sphere/>", "", "black", "noMedium", "the scene has no medium"});
    check({ball_before_sky, "<sphere/>", "<sphere/><lightRayDensityMultiplier>0</lightRayDensityMultiplier>",
           "background", "noMedium", "lightRayDensityMultiplier is 0"});
    const Scene scene = parse(lit_ball);
    CHECK(explanation_of(scene, {}, {8, 16, 8, 16}).cause == "");
    const Found crop = explanation_of(scene, {}, {0, 3, 0, 3});
    CHECK(crop.cause == "missed");
    CHECK_THAT(crop.text, Contains("move --crop"));
}

TEST_CASE("media that cannot be seen are explained", "[gpu][explain]") {
    check({lit_ball, "<sphere/>", "<sphere/><lightRayDensityMultiplier>1e-9</lightRayDensityMultiplier>", "black",
           "tooThin", "the largest optical depth in view is 5e-09"});
    check({ball_before_sky, "<sphere/>", "<sphere/><lightRayDensityMultiplier>1e-5</lightRayDensityMultiplier>",
           "background", "tooThin", "by 2e+04 or so"});
    check({ball_before_sky, "<sigma_a>0.5</sigma_a>", "<sigma_a>0</sigma_a>", "background", "furnace",
           "absorbs next to nothing"});
    check({ball_before_sky, sigma_s, "<sigma_s>0</sigma_s><medium r=\"0.5\" g=\"0.5\" b=\"0.5\"/>", "background",
           "equilibrium", "glows just as its background does"});
    const std::string fine = with(ball_before_sky, "<rayPerPixelCount>4", "<rayPerPixelCount>64");
    check({fine, "<sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>", "<sigma_a>0.0003</sigma_a><sigma_s>0.0102</sigma_s>",
           "background", "indistinct", "less than a screen shows"});
    check({slab_text, "<sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>", "<sigma_a>20</sigma_a><sigma_s>0</sigma_s>",
           "black", "absorbsAll", "its optical depth reaches 2"});
    check({slab_text, sigma_s, "<sigma_s>2e4</sigma_s><maxDepth>0</maxDepth>", "black", "depthLimit",
           "ended at maxDepth 0"});
    const std::string fog = with(slab_text, "<sigma_a>0.5</sigma_a>",
                                 "<lightRayDensityMultiplier>10</lightRayDensityMultiplier><sigma_a>0.005</sigma_a>");
    check({fog, camera, "<camera fov=\"30\"/>", "noise", "inside", "stands inside of the medium"});
    check({slab_text, camera + picture,
           "<camera fov=\"30\"/><lightRayDensityMultiplier>4000</lightRayDensityMultiplier><integrator "
           "scattering=\"none\">deltaTracking</integrator>" +
               picture,
           "black", "inside", "stands inside of the medium"});
    check({fog, camera, "<camera projection=\"equirectangular\"/>", "noise", "inside",
           "move the camera out or lower sigma_a"});
    const std::string lit_slab = with(slab_text, "<backgroundColor r=\"0.5\" g=\"0.5\" b=\"0.5\"/>",
                                      "<light x=\"0\" y=\"0\" z=\"1\" r=\"5\" g=\"5\" b=\"5\"/>");
    check({lit_slab, "z=\"1\" r", "z=\"-1\" r", "", "", ""}); // thin enough to be seen from behind
    const std::string thick = with(lit_slab, "<sigma_a>0.5</sigma_a>", "<sigma_a>20</sigma_a>");
    check({thick, "z=\"1\" r", "z=\"-1\" r", "black", "backlit", "the <light> stands behind it, at (0, 0, -1)"});
}

TEST_CASE("peaked phase functions that pass the camera by are explained", "[gpu][explain]") {
    const std::string before =
        with(with(lit_ball, light, "<light x=\"0\" y=\"0\" z=\"1\" r=\"1\" g=\"1\" b=\"1\"/>"),
             "<sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>", "<sigma_a>0</sigma_a><sigma_s>0.05</sigma_s>");
    check({before, "<sphere/>", "<sphere/><heyneygreenstein_g>0.99</heyneygreenstein_g>", "black", "phasePeak",
           "heyneygreenstein_g 0.99"});
    const char* others[] = {"<heyneygreenstein_g>0.99</heyneygreenstein_g><phase alpha=\"1\">draine</phase>",
                            "<phase index=\"1.05\" backscatter=\"0.0003\">fournierForand</phase>"};
    for (const char* other : others)
        check({before, "<sphere/>", std::string("<sphere/>") + other, "black", "phasePeak", "its phase function"});
}

namespace {

// 32^3 voxels, each 0.1 world units, about the origin; glows if `kelvin` is given.
SceneOverrides grid(const std::function<float(glm::ivec3)>& density, std::optional<float> kelvin = {}) {
    GridRecipe recipe{{-16, -16, -16}, {15, 15, 15}, density};
    recipe.linear = glm::dmat3(0.1);
    std::vector<GridRecipe> grids = {recipe};
    if (kelvin) {
        grids.push_back(recipe);
        grids.back().value = [kelvin](glm::ivec3) { return *kelvin; };
        grids.back().name = "temperature";
    }
    SceneOverrides overrides;
    overrides.grid = write_grids(grids).path;
    return overrides;
}

float full(glm::ivec3) {
    return 1.0f;
}

const std::string lit_grid = with(lit_ball, "<sphere/>", "");

} // namespace

TEST_CASE("grids that show nothing are explained", "[gpu][explain][long]") {
    CHECK(explanation_of(lit_grid, grid(full)).cause == "");
    // A shaft through the middle, 0.8 across, and a camera that sees nothing else.
    const auto shaft = [](glm::ivec3 i) { return std::abs(i.x + 0.5) < 4 && std::abs(i.y + 0.5) < 4 ? 0.0f : 1.0f; };
    const std::string narrow = with(lit_grid, "fov=\"30\"", "fov=\"2\"");
    CHECK(explanation_of(narrow, grid(full)).cause == "");
    const Found hollow = explanation_of(
        narrow, grid([](glm::ivec3 i) { return std::abs(i.x) < 12 && std::abs(i.y) < 12 ? 0.0f : 1.0f; }));
    CHECK(hollow.cause == "hollow");
    CHECK_THAT(hollow.text, Contains("the density is 0 wherever they go"));
    // Majorant cells at the shaft's edge reach into it: all that is known is that little is in it.
    CHECK(explanation_of(narrow, grid(shaft)).picture == "black");
    const std::string by_voxel =
        with(lit_grid, "<sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>", "<sigma_a>0</sigma_a><sigma_s>1e-6</sigma_s>");
    const Found thin = explanation_of(by_voxel, grid(full));
    CHECK(thin.cause == "tooThin");
    CHECK_THAT(thin.text, Contains("per voxel, of 0.1 world units"));
    const Found empty = explanation_of(lit_grid, grid([](glm::ivec3) { return 0.0f; }));
    CHECK(empty.cause == "noMedium");
    CHECK_THAT(empty.text, Contains("the grid \"density\" has no voxels") && Contains("vkvol info "));
}

TEST_CASE("glow that does not glow is explained", "[gpu][explain]") {
    const std::string fire =
        with(lit_grid, light, "<emission model=\"blackbody\" r=\"1\" g=\"1\" b=\"1\" temperatureScale=\"1\"/>");
    CHECK(explanation_of(fire, grid(full, 1800.0f)).cause == "");
    const Found cold = explanation_of(fire, grid(full, 640.0f));
    CHECK(cold.cause == "coldGlow");
    CHECK_THAT(cold.text, Contains("\"temperature\" reaches 640 kelvin") && Contains("raise temperatureScale"));
    const Found cut = explanation_of(with(fire, "temperatureScale", "temperatureCutoff=\"2000\" temperatureScale"),
                                     grid(full, 1800.0f));
    CHECK(cut.cause == "coldGlow");
    CHECK_THAT(cut.text, Contains("below the temperatureCutoff of 2000"));
    const Found missing = explanation_of(fire, grid(full));
    CHECK(missing.cause == "noGlow");
    CHECK_THAT(missing.text, Contains("from a grid \"temperature\""));
    const Found colourless = explanation_of(with(fire, "r=\"1\" g=\"1\" b=\"1\" ", ""), grid(full, 1800.0f));
    CHECK(colourless.cause == "blackSource");
    CHECK_THAT(colourless.text, Contains("<emission> at "));
    const Found left_out =
        explanation_of(with(fire, "<emission", "<integrator>nanoVDBSimple</integrator><emission"), grid(full, 1800.0f));
    CHECK(left_out.cause == "noGlow");
    CHECK_THAT(left_out.text, Contains("leaves emission out"));
}

TEST_CASE("exposures that do not suit are explained, with one that does", "[gpu][explain]") {
    const Scene scene = parse(with(ball_before_sky, "</height>", "</height><medium/>"));
    CHECK(explanation_of(scene).cause == "");
    const Found bright = explanation_of(scene, {{}, 4.0});
    CHECK(bright.picture == "white");
    CHECK(bright.cause == "overexposed");
    CHECK_THAT(bright.text, Contains("100 % of the pixels clip") && Contains("at exposure 4") &&
                                Contains("the background alone is 8"));
    const Found dark = explanation_of(scene, {{}, -14.0});
    CHECK(dark.cause == "dim");
    const auto suits = [&scene](const std::string& text) {
        std::smatch match;
        REQUIRE(std::regex_search(text, match, std::regex("--exposure (\\S+) suits")));
        return explanation_of(scene, {{}, std::stod(match[1].str())}).cause;
    };
    CHECK(suits(bright.text) == "");
    CHECK(suits(dark.text) == "");
    CHECK(explanation_of(scene, {{}, {}, true}).cause == "");
    // Without a picture for the screen nothing is too bright or too dark.
    RenderJob job;
    job.disk_cache = false;
    job.crop = {0, 24, 0, 24};
    const Scene glaring = parse(with(lit_ball, "r=\"5\" g=\"5\" b=\"5\"", "r=\"1e-6\" g=\"1e-6\" b=\"1e-6\""));
    const RenderResult result = render(test_device(), glaring, job);
    CHECK_FALSE(explain(glaring, result, {}));
}

TEST_CASE("exposures that suit come on top of the camera's", "[gpu][command][explain]") {
    const Folder folder("");
    folder.write("lit.xml",
                 "<options><sphere/><sigma_a>0.1</sigma_a><sigma_s>3</sigma_s><width>16</width><height>16</height>"
                 "<camera z=\"5\" fov=\"30\" shutter=\"0.01\" fNumber=\"8\"/>"
                 "<light y=\"1\" z=\"1\" r=\"5\" g=\"5\" b=\"5\"/></options>");
    const Run dim = folder.vkvol("lit.xml --spp 8 -o a.png");
    CHECK_THAT(dim.text, Contains("next to nothing at exposure -12.9"));
    std::smatch match;
    REQUIRE(std::regex_search(dim.text, match, std::regex("--exposure (\\S+) suits")));
    const Run bright = folder.vkvol("lit.xml --spp 8 -o a.png --exposure=" + match[1].str());
    CHECK(bright.code == exit_done);
    CHECK_THAT(bright.text, !Contains("suits"));
}

TEST_CASE("renders that ended early, and those that found nothing, are explained", "[gpu][explain]") {
    const Scene scene = parse(lit_ball);
    RenderJob job;
    job.disk_cache = false;
    job.crop = {0, 24, 0, 24};
    RenderResult result = render(test_device(), scene, job);
    std::fill(result.film.samples.begin() + 100, result.film.samples.end(), 0u);
    CHECK(found(explain(scene, result, {})).cause == "unfinished");
    CHECK_THAT(found(explain(scene, result, {})).text,
               Contains("83 % of the pixels have no sample") && Contains("--time"));
    result.interrupted = true;
    CHECK_THAT(found(explain(scene, result, {})).text, Contains("--resume"));
    // One path, which meets the medium once in thirty times.
    const Found unlit =
        explanation_of(with(with(with(lit_ball, "<sigma_a>0.5</sigma_a><sigma_s>2</sigma_s>",
                                      "<sigma_a>0</sigma_a><sigma_s>0.02</sigma_s>"),
                                 "<rayPerPixelCount>4", "<rayPerPixelCount>1"),
                            "<width>24</width><height>24</height>", "<width>1</width><height>1</height>"));
    CHECK(unlit.cause == "unlit");
    CHECK_THAT(unlit.text, Contains("none of its 1 paths met light; the optical depth in view reaches 0.04"));
}

TEST_CASE("light that the medium does not scatter is explained", "[gpu][explain]") {
    const std::string blue = with(lit_ball, "<sigma_s>2</sigma_s>", "<sigma_s r=\"0\" g=\"0\" b=\"5\"/>");
    const Found red = explanation_of(with(blue, "r=\"5\" g=\"5\" b=\"5\"", "r=\"5\" g=\"0\" b=\"0\""));
    CHECK(red.cause == "unlikeColours");
    CHECK_THAT(red.text, Contains("the <light> has (5, 0, 0), of which sigma_s (0, 0, 5) scatters nothing"));
    CHECK(explanation_of(blue).cause == "");
}

TEST_CASE("pictures of several media explain themselves as well", "[gpu][explain]") {
    const auto two = [](const std::string& sigmas, const std::string& more) {
        return explanation_of("<volumes><volume><sphere/>" + sigmas + "</volume><volume><box x=\"0.5\"/>" + sigmas +
                              "<heyneygreenstein_g>0.9</heyneygreenstein_g></volume></volumes><camera z=\"6\" "
                              "fov=\"40\"/>" +
                              picture + more)
            .cause;
    };
    const std::string behind = "<backgroundColor r=\"1\" g=\"1\" b=\"1\"/>",
                      sun = "<light y=\"1\" r=\"9\" g=\"9\" b=\"9\"/>";
    CHECK(two("<sigma_a>0</sigma_a><sigma_s>1e-4</sigma_s>", behind) == "tooThin");
    CHECK(two("<sigma_a>0</sigma_a><sigma_s>2</sigma_s>", behind) == "furnace");
    CHECK(two("<sigma_a>9</sigma_a><sigma_s>0</sigma_s>", sun) == "absorbsAll");
    CHECK(two("<sigma_a>0</sigma_a><sigma_s>0</sigma_s>", behind) == "noMedium");
    CHECK(two("<sigma_a>1</sigma_a><sigma_s>1</sigma_s>", sun) == "");
    CHECK(two("<sigma_a>1</sigma_a><sigma_s>1</sigma_s>", sun + "<integrator>deltaTracking</integrator>") != "");
}

TEST_CASE("what is seen may be white before black", "[gpu][explain]") {
    const Found white = explanation_of(with(lit_ball, "r=\"5\" g=\"5\" b=\"5\"", "r=\"5e9\" g=\"5e9\" b=\"5e9\""));
    CHECK(white.cause == "overexposed");
    CHECK_THAT(white.text, Contains("of the pixels that are not black clip: ") && Contains("--exposure -"));
}

TEST_CASE("pictures that show something need no explanation", "[gpu][explain][long]") {
    const std::string sun_and_sky = "<backgroundColor r=\"0.12\" g=\"0.26\" b=\"0.56\"/>"
                                    "<light x=\"0.74\" y=\"0.5\" z=\"-0.4\" r=\"6\" g=\"5.5\" b=\"4.7\"/>";
    SceneOverrides cloud;
    cloud.grid = write_grid(cloud_grid()).path;
    for (const char* integrator : {"cachedRatioTracking", "deltaTracking", "regularTracking", "nanoVDBSimple"})
        for (const char* samples : {"1", "8"})
            for (const char* sigma : {"0.3", "30"}) {
                CAPTURE(integrator, samples, sigma);
                const std::string body =
                    fmt::format("<sigma_a unit=\"world\">0.05</sigma_a><sigma_s unit=\"world\">{}</sigma_s><camera "
                                "z=\"20\" fov=\"40\"/>"
                                "<width>16</width><height>12</height><rayPerPixelCount>{}</rayPerPixelCount>"
                                "<integrator>{}</integrator>{}",
                                sigma, samples, integrator, sun_and_sky);
                CHECK(explanation_of(body, cloud).text == "");
            }
    // From within: a fog that has something to see in it, or an end.
    for (const char* sigma : {"0.2", "1"})
        CHECK(explanation_of(fmt::format("<sphere radius=\"2\"/><sigma_a>0.1</sigma_a><sigma_s>{}</sigma_s>"
                                         "<camera fov=\"90\"/>{}{}",
                                         sigma, light, picture))
                  .text == "");
}

// What the derivations of some say is black, or all background: rightly so.
TEST_CASE("of the hard scenes those that show nothing are explained, and no other", "[gpu][explain][long]") {
    const std::map<std::string, std::string> bare = {
        {"01-absorbing-slab-closed-form-17", "absorbsAll"},
        {"01-absorbing-slab-closed-form-87", "absorbsAll"},
        {"01-opaque-slab", "absorbsAll"},
        {"04-furnace-box", "furnace"},
        {"04-furnace-grid", "furnace"},
        {"04-furnace-sphere", "furnace"},
        {"09-point-in-fog", "inside"}, // all pixels are alike
        {"09-point-in-fog-beside", "overexposed"},
        {"09-point-in-fog-forward", "inside"},
        {"13-empty-grid", "noMedium"},
        {"13-zero-density", "noMedium"},
        {"19-ray-in-border-face", "indistinct"},
        {"33-blackbody-cold", "coldGlow"},
    };
    for (const auto& entry : std::filesystem::directory_iterator(VKVOL_SOURCE_DIR "/scenes/hard")) {
        if (entry.path().extension() != ".xml")
            continue;
        std::stringstream stream;
        stream << std::ifstream(entry.path()).rdbuf();
        SceneOverrides overrides;
        std::smatch match;
        const std::string xml = stream.str();
        if (std::regex_search(xml, match, std::regex("<densityField[^>]*>([^<]*)<")))
            overrides.grid = std::filesystem::path(VKVOL_TEST_FIELDS) / match[1].str();
        Scene scene = parse_scene(xml, entry.path(), {}, overrides);
        scene.settings.spp = std::min(scene.settings.spp, 4u);
        const auto expected = bare.find(entry.path().stem().string());
        const Found explanation = explanation_of(scene);
        CAPTURE(entry.path().stem().string(), explanation.text);
        CHECK(explanation.cause == (expected == bare.end() ? "" : expected->second));
    }
}

TEST_CASE("an explanation is one note and a report's fact, and no error", "[gpu][command][explain]") {
    const Folder folder("");
    const auto report = [&folder] { return nlohmann::json::parse(folder.text("r.json"))["explanation"]; };
    folder.write("dark.xml", "<options><sphere/><camera z=\"5\"/><width>8</width><height>8</height></options>");
    const Run dark = folder.vkvol("dark.xml --report r.json");
    CHECK(dark.code == exit_done);
    CHECK(dark.text.find("vkvol: note: the picture will be black: nothing gives light") == 0);
    CHECK(dark.text.find("nothing gives light") == dark.text.rfind("nothing gives light"));
    CHECK(report()["cause"] == "noLight");
    CHECK(folder.vkvol("dark.xml -q").text.empty());
    folder.write("away.xml", "<options><sphere/><camera z=\"5\" yaw=\"180\"/><width>8</width><height>8</height>"
                             "<backgroundColor g=\"0.5\"/></options>");
    const Run away = folder.vkvol("away.xml --report r.json --strict");
    CHECK(away.code == exit_done);
    CHECK_THAT(away.text, Contains("vkvol: note: the picture shows its background alone: no ray enters the medium"));
    const nlohmann::json facts = report();
    CHECK(facts["picture"] == "background");
    CHECK(facts["cause"] == "missed");
    CHECK(facts["mediumBox"] == nlohmann::json({{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}));
    CHECK(facts["camera"]["position"] == nlohmann::json({0.0, 0.0, 5.0}));
    CHECK(facts["raysEntering"] == 0.0);
    CHECK(facts["opticalDepth"]["most"] == 0.0);
    CHECK(facts["pixelsUnlikeBackground"] == 0);
    folder.write("good.xml", "<options><sphere/><camera z=\"5\"/><width>8</width><height>8</height>"
                             "<backgroundColor g=\"0.5\"/></options>");
    CHECK_THAT(folder.vkvol("good.xml --report r.json").text, !Contains("note"));
    CHECK(report().is_null());
}
