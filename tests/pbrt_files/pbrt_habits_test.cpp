// What scenes of pbrt-v4 as people have them say beside its manual: packed files, older names, lists of odd lengths.
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>
#include <numbers>

#include "gzip.h"
#include "image_io.h"
#include "pbrt_scenes.h"
#include "polygons.h"
#include "support/scenes.h"
#include "support/test_directory.h"

using namespace vkvol;
using Catch::Contains;

namespace {

std::filesystem::path gzipped(const std::filesystem::path& file) {
    REQUIRE(std::system(fmt::format("gzip -f '{}'", file.string()).c_str()) == 0);
    return file.string() + ".gz";
}

std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

Scene scene_in(const std::filesystem::path& folder, const std::string& world) {
    const std::string text = "Camera \"perspective\" WorldBegin " + world;
    return parse_scene(translate_pbrt(read_pbrt(text, folder / "s.pbrt")), folder / "s.pbrt");
}

const std::string ply_triangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string one_triangle = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] ";

} // namespace

TEST_CASE("what gzip packed is read", "[cpu][pbrt]") {
    const TestDirectory directory;
    const std::string text = "Material \"diffuse\" \"rgb reflectance\" [ .1 .8 .1 ] Shape \"sphere\"\n";
    const std::string packed = content_of(gzipped(directory.write("ball.pbrt", text)));
    CHECK(near(scene_in(directory.path, "Include \"ball.pbrt.gz\"").surfaces.at(0).material.color, {.1, .8, .1}));
    directory.write("whole.pbrt", "Camera \"perspective\" WorldBegin " + text);
    CHECK(load_scene(gzipped(directory.path / "whole.pbrt"), {}).surfaces.size() == 1);
    CHECK(unpacked(packed, "a", 1000) == text);
    CHECK(unpacked(packed + packed, "a", 1000) == text + text); // as gzip has it
    CHECK(unpacked(packed + "padding", "a", 1000) == text);
    CHECK(unpacked(text, "a", 1) == text);
    const std::string long_text(3'000'000, 'x');
    CHECK(unpacked(content_of(gzipped(directory.write("long", long_text))), "a", 4'000'000) == long_text);
    CHECK_THROWS_WITH(unpacked(content_of(directory.path / "long.gz"), "a", 2'000'000),
                      Contains("a: would be more than 1"));
    for (const std::size_t length : {std::size_t(2), std::size_t(20), packed.size() - 1})
        CHECK_THROWS_WITH(unpacked(packed.substr(0, length), "a", 1000), Contains("a: is damaged"));
    std::string wrong = packed;
    wrong[wrong.size() - 6] ^= 1; // of its checksum
    CHECK_THROWS_WITH(unpacked(wrong, "a", 1000), Contains("a: is damaged"));
    const Polygons mesh = read_polygons(gzipped(directory.write("corner.ply", ply_triangle)));
    CHECK(mesh.triangles.size() == 1);
    CHECK(scene_in(directory.path, "Shape \"plymesh\" \"string filename\" \"corner.ply.gz\"").surfaces.size() == 1);
}

TEST_CASE("shapes of pbrt that nothing meets are not there", "[cpu][pbrt]") {
    CHECK(world_of("Shape \"sphere\" \"float alpha\" 1").warnings.empty());
    const Scene none = world_of("Shape \"sphere\" \"float alpha\" 0");
    CHECK((none.surfaces.empty() && none.warnings.empty()));
    const Scene lamp = world_of("AreaLightSource \"diffuse\" Shape \"sphere\" \"float alpha\" 0");
    CHECK(lamp.surfaces.size() == 1);
    REQUIRE(lamp.warnings.size() == 1);
    CHECK_THAT(lamp.warnings[0], Contains("the light that pbrt does not show"));
}

TEST_CASE("parameters of pbrt by other names, and more than once", "[cpu][pbrt]") {
    const auto glow = [](const std::string& scale) {
        const Scene scene = world_of("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb Le\" [ 1 1 1 ] " +
                                     scale + " MediumInterface \"a\" \"\" Material \"interface\" Shape \"sphere\"");
        CHECK(scene.volumes.size() == 1);
        CHECK_THAT(fmt::format("{}", fmt::join(scene.warnings, "\n")), !Contains("Le"));
        return scene.volumes.at(0).Le.x;
    };
    CHECK(glow("\"float LeScale\" 0.5") == Approx(0.5 * glow("")));
    CHECK(glow("\"float Lescale\" 3") == Approx(3.0 * glow("")));
    const Scene sky = world_of("LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"float scale\" 2 \"float scale\" 16");
    CHECK(near(sky.background, glm::dvec3(16.0)));
    CHECK(sky.warnings.empty());
    const auto filter = [](const std::string& parameters) {
        return scene_of("PixelFilter \"gaussian\" " + parameters + " Camera \"perspective\" WorldBegin");
    };
    const Scene wide = filter("\"float xradius\" 2 \"float yradius\" 2"); // of a sigma of 0.5
    CHECK((wide.settings.pixel_filter_radius == 1.5 && wide.warnings.empty()));
    const Scene cut = filter("\"float xradius\" 2 \"float yradius\" 2 \"float sigma\" 1");
    CHECK((cut.settings.pixel_filter_radius == 2.0 && cut.warnings.size() == 1));
    const Scene wheel =
        world_of("Material \"coatedconductor\" \"float conductor.roughness\" .05 \"float thickness\" .1 "
                 "Shape \"sphere\"");
    CHECK(wheel.surfaces.at(0).material.roughness == Approx(std::sqrt(0.05)));
    CHECK(wheel.warnings.size() == 1); // of its coat
}

TEST_CASE("pbrt's places on textures go backwards and are shifted", "[cpu][pbrt]") {
    const std::string usual = "\"point2 uv\" [ 0 0 1 0 0 1 ]";
    const auto places = [&](const std::string& texture, const std::string& shape) {
        const Scene scene = world_of("Texture \"t\" \"spectrum\" " + texture +
                                     " Material \"diffuse\" \"texture reflectance\" \"t\" " + shape);
        CHECK(scene.warnings.empty());
        const Surface& surface = scene.surfaces.at(0);
        std::vector<glm::vec2> all;
        for (int corner : {0, 2, 1}) // mirrored
            all.push_back(std::get<TriangleSurface>(surface.shape).places.at(0)[corner] *
                          glm::vec2(surface.material.repeat));
        return all;
    };
    using Places = std::vector<glm::vec2>;
    const std::string image = "\"imagemap\" \"string filename\" \"a.png\" ";
    CHECK(places(image + "\"float vscale\" -1", one_triangle + usual) == Places{{0, 0}, {1, 0}, {0, -1}});
    CHECK(places(image + "\"float uscale\" -2 \"float udelta\" .25 \"float vdelta\" 1", one_triangle + usual) ==
          Places{{0.25f, 1}, {-1.75f, 1}, {0.25f, 2}});
    CHECK(places(image + "\"float uscale\" 2", one_triangle + usual) == Places{{0, 0}, {2, 0}, {0, 1}});
    CHECK(places("\"checkerboard\" \"float uscale\" -4 \"float vdelta\" 1", one_triangle + usual) ==
          Places{{0, 0.5f}, {-2, 0.5f}, {0, 1}});
    const Scene ball = world_of("Texture \"t\" \"spectrum\" " + image +
                                "\"float vdelta\" 1 Material \"diffuse\" "
                                "\"texture reflectance\" \"t\" Shape \"sphere\"");
    REQUIRE(ball.warnings.size() == 1);
    CHECK_THAT(ball.warnings[0], Contains("\"udelta\" and \"vdelta\" are left out"));
}

TEST_CASE("lists of pbrt's meshes that have odd lengths are left out", "[cpu][pbrt]") {
    const auto mesh = [](const std::string& list, const std::string& noted) {
        const Scene scene = world_of(one_triangle + list);
        REQUIRE(scene.warnings.size() == 1);
        CHECK_THAT(scene.warnings[0], Contains(noted));
        return std::get<TriangleSurface>(scene.surfaces.at(0).shape);
    };
    CHECK(mesh("\"normal3 N\" [ 0 0 1 ]", "\"N\": 1 of them for 3 points are left out").triangles.size() == 1);
    CHECK(mesh("\"point2 uv\" [ 0 0 ]", "\"uv\": 1 of them for 3 points are left out").triangles.size() == 1);
    CHECK(mesh("\"integer indices\" [ 0 1 2 0 1 ]", "the last 2 of \"indices\" are left out").triangles.size() == 1);
}

TEST_CASE("pbrt's images become their means where they are left out", "[cpu][pbrt]") {
    const TestDirectory directory;
    directory.write("corner.ply", ply_triangle);
    const RadianceMap map{2, 1, {{0.2f, 0.4f, 0.6f}, {0.4f, 0.2f, 0.0f}}, 0};
    const std::string name = write_sky(map).file.string();
    const glm::dvec3 mean(0.3, 0.3, 0.3);
    const std::string lamp = "AreaLightSource \"diffuse\" \"string filename\" \"" + name + "\" ";
    const auto emission = [&](const std::string& more) {
        return scene_in(directory.path, lamp + more + " Shape \"disk\"").surfaces.at(0).emission;
    };
    CHECK(near(emission(""), mean, 1e-6));
    CHECK(near(emission("\"float scale\" 2"), 2.0 * mean, 1e-6));
    // The power of an even one: its area and pi.
    CHECK(near(emission("\"float power\" 7"), glm::dvec3(7.0 / (std::numbers::pi * std::numbers::pi)), 1e-6));
    directory.write("bad.exr", "no picture");
    const Scene bad = scene_in(directory.path, "AreaLightSource \"diffuse\" \"string filename\" \"bad.exr\" Shape "
                                               "\"disk\" Shape \"sphere\"");
    CHECK((near(bad.surfaces.at(0).emission, glm::dvec3(1.0)) && near(bad.surfaces.at(1).emission, glm::dvec3(1.0))));
    const std::string shape =
        " Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"plymesh\" \"string filename\" "
        "\"corner.ply\"";
    const Scene even =
        scene_in(directory.path, "Texture \"t\" \"spectrum\" \"imagemap\" \"float scale\" .5 \"string filename\" \"" +
                                     name + "\"" + shape);
    CHECK(near(even.surfaces.at(0).material.color, 0.5 * mean, 1e-6));
    CHECK(even.surfaces.at(0).material.texture.empty());
    REQUIRE(even.warnings.size() == 1);
    CHECK_THAT(even.warnings[0], Contains("has no places on its texture"));
    const Scene board =
        scene_in(directory.path, "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ .2 .4 .6 ] "
                                 "\"rgb tex2\" [ 0 0 .2 ]" +
                                     shape);
    CHECK(near(board.surfaces.at(0).material.color, {.1, .2, .4}, 1e-6));
}
