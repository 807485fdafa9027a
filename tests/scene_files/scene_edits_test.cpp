// Changes of scenes by a viewer, as what the changed text says.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "error.h"
#include "scene_edits.h"
#include "scene_hash.h"
#include "scene_xml.h"
#include "shared/constants.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Scene read(const std::string& xml, const Defines& defines = {}) {
    return parse_scene(xml, std::filesystem::path(VKVOL_SOURCE_DIR) / "scenes" / "edited.xml", defines);
}

constexpr const char* ball =
    "<options><!-- a ball --><sphere/><sigma_s>1</sigma_s><lightRayDensityMultiplier>0.5</lightRayDensityMultiplier>"
    "<camera lookAt=\"1 2 3\" distance=\"9\" azimuth=\"40\" lensRadius=\"0.1\"/>"
    "<light x=\"0\" y=\"3\" z=\"4\" r=\"1\" g=\"2\" b=\"3\" multiplier=\"$sun\"/>"
    "<lights><point x=\"1\" y=\"2\" z=\"3\" power=\"${= 2*${watts:-5}}\"/>"
    "<sun group=\"key\" zenith=\"30\" azimuth=\"90\" r=\"1\" g=\"1\" b=\"1\"/></lights>"
    "<backgroundColor r=\"0.5\" g=\"0.5\" b=\"0.5\"/></options>";

} // namespace

TEST_CASE("scenes that are not changed mean what they meant", "[cpu][live]") {
    for (const char* name : {"cumulus.xml", "explosion.xml", "bench/cloud.xml", "gallery/god_rays.xml"}) {
        CAPTURE(name);
        const std::filesystem::path file = std::filesystem::path(VKVOL_SOURCE_DIR) / "scenes" / name;
        std::ifstream in(file);
        const std::string xml{std::istreambuf_iterator<char>(in), {}};
        CHECK(scene_hash(parse_scene(edited(xml, {}), file)) == scene_hash(parse_scene(xml, file)));
    }
    CHECK_THAT(edited(ball, {}), Contains("<!-- a ball -->"));
}

TEST_CASE("cameras, lights, densities and integrators that a viewer changes", "[cpu][live]") {
    const Defines defines = {{"sun", "4"}};
    const Scene before = read(ball, defines);
    SceneEdits edits;
    edits.camera = before.camera;
    edits.camera->position = {1.25, -3.5, 1e3};
    edits.camera->fov = 33.0;
    edits.lights[0] = {0.25, glm::dvec3(-1.0, 0.0, 0.0)};
    edits.lights[1] = {3.0, {}};
    edits.lights[2] = {1.0, glm::dvec3(0.0, 0.6, -0.8)};
    edits.lights[3] = {0.5, glm::dvec3(1.0, 0.0, 0.0)}; // which has none
    edits.lights[99] = {7.0, {}};                       // which is not there any more
    edits.density = 6.0;
    edits.integrator = "ratioTracking:nee=tentative:flight=weighted";
    const std::string xml = edited(ball, edits);
    CAPTURE(xml);
    const Scene after = read(xml, defines);
    CHECK(glm::distance(after.camera.position, edits.camera->position) < 1e-5);
    CHECK(after.camera.fov == 33.0);
    CHECK(std::abs(after.camera.pitch - before.camera.pitch) < 1e-6);
    CHECK(std::abs(after.camera.yaw - before.camera.yaw) < 1e-6);
    CHECK(std::abs(after.camera.lens.focus - before.camera.lens.focus) < 1e-6);
    REQUIRE(after.lights.size() == before.lights.size());
    const auto& beam = std::get<DirectionalLight>(after.lights[0]);
    CHECK(glm::distance(beam.irradiance, Rgb(1.0, 2.0, 3.0)) < 1e-8);
    CHECK(glm::distance(beam.direction, glm::dvec3(-1.0, 0.0, 0.0)) < 1e-8);
    CHECK(glm::distance(std::get<PointLight>(after.lights[1]).intensity,
                        3.0 * std::get<PointLight>(before.lights[1]).intensity) < 1e-7);
    const auto& sun = std::get<SunLight>(after.lights[2]);
    CHECK(glm::distance(sun.direction, glm::dvec3(0.0, 0.6, -0.8)) < 1e-8);
    CHECK(glm::distance(sun.irradiance, std::get<SunLight>(before.lights[2]).irradiance) < 1e-8);
    CHECK(after.background == Rgb(0.25));
    CHECK(after.volumes.front().density_scale == Approx(3.0));
    CHECK(after.settings.integrator == "ratioTracking");
    CHECK(after.settings.choices.nee == NEE_TENTATIVE);
}

TEST_CASE("what shines in a scene, and where it is", "[cpu][live]") {
    const std::vector<Shining> all = what_shines(ball);
    REQUIRE(all.size() == 4);
    CHECK(all[0].name == "light");
    CHECK(glm::distance(*all[0].direction, glm::dvec3(0.0, 0.6, 0.8)) < 1e-12);
    CHECK(all[1].name == "point");
    CHECK_FALSE(all[1].direction);
    CHECK(all[2].name == "sun (key)");
    CHECK(glm::distance(*all[2].direction, glm::dvec3(0.5, std::sqrt(0.75), 0.0)) < 1e-12);
    CHECK(all[3].name == "backgroundColor");
    // A direction that is not written in numbers is not known.
    CHECK_FALSE(what_shines("<options><light x=\"$a\" y=\"1\" z=\"0\"/></options>").front().direction);
    CHECK_THROWS_AS(what_shines("<options><light"), InputError);
}

TEST_CASE("the density of several media is changed once for each", "[cpu][live]") {
    const std::string xml =
        "<options><volumes><volume name=\"a\"><sphere/><sigma_s>1</sigma_s></volume><volume like=\"a\"><transform>"
        "<translate x=\"5\"/></transform></volume><volume><sphere x=\"9\"/><sigma_s>2</sigma_s>"
        "<lightRayDensityMultiplier>3</lightRayDensityMultiplier></volume></volumes></options>";
    SceneEdits edits;
    edits.density = 2.0;
    const Scene scene = read(edited(xml, edits));
    REQUIRE(scene.volumes.size() == 3);
    CHECK(scene.volumes[0].density_scale == 2.0);
    CHECK(scene.volumes[1].density_scale == 2.0);
    CHECK(scene.volumes[2].density_scale == 6.0);
    // What stands in the scene itself is one more, and shines.
    const std::string own =
        "<options><box/><sigma_a>1</sigma_a><medium r=\"1\"/>" + xml.substr(std::strlen("<options>"));
    const Scene more = read(edited(own, edits));
    REQUIRE(more.volumes.size() == 4);
    CHECK(more.volumes[0].density_scale == 2.0);
    CHECK(more.volumes[3].density_scale == 6.0);
    CHECK(what_shines(own).size() == 1);
}
