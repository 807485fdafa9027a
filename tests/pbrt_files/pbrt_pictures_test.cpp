// Scenes of pbrt-v4 as pictures, and `vkvol convert`.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "error.h"
#include "image_io.h"
#include "scene_xml.h"
#include "support/command_folder.h"
#include "support/images.h"
#include "support/test_directory.h"
#include "support/thorough.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Direction of a place on a square map of equal areas, by Clarberg's mapping as pbrt has it: x and y from 0 to 1, y
// down its rows; z up.
glm::dvec3 pbrt_direction(double x, double y) {
    const double u = 2.0 * x - 1.0, v = 2.0 * y - 1.0;
    const double signed_distance = 1.0 - (std::abs(u) + std::abs(v)), r = 1.0 - std::abs(signed_distance);
    const double phi = (r == 0.0 ? 1.0 : (std::abs(v) - std::abs(u)) / r + 1.0) * std::numbers::pi / 4.0;
    const double flat = r * std::sqrt(2.0 - r * r);
    return {std::copysign(flat * std::cos(phi), u), std::copysign(flat * std::sin(phi), v),
            std::copysign(1.0 - r * r, signed_distance)};
}

constexpr int map_size = 32;

// Radiance's format, without runs: one bright texel.
void write_map(const std::filesystem::path& file, int column, int row) {
    std::ofstream stream(file, std::ios::binary);
    stream << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << map_size << " +X " << map_size << "\n";
    for (int i = 0; i < map_size * map_size; ++i)
        stream.write(i == row * map_size + column ? "\x80\x80\x80\x88" : "\x80\x80\x80\x78", 4); // 128 and 1 / 512
}

glm::dvec2 brightest(const Film& film) {
    glm::dvec2 sum(0.0);
    double all = 0.0;
    for (int i = 0; i < film.width() * film.height(); ++i) {
        const double light = std::max(0.0, double(film.mean[std::size_t(i)].x) - 0.1);
        sum += light * (glm::dvec2(i % film.width(), i / film.width()) + 0.5);
        all += light;
    }
    return sum / all;
}

const std::string ball = R"(LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 4
Integrator "volpath" "integer maxdepth" 1000
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .1 .1 .1 ] "rgb sigma_s" [ 2 2 2 ]
WorldBegin
LightSource "point" "rgb I" [ 9 8 7 ] "point3 from" [ 2 3 4 ]
Material "interface"
MediumInterface "fog" ""
Shape "sphere"
)";

} // namespace

TEST_CASE("pbrt's maps of the sky are seen where pbrt sees them", "[gpu][pbrt]") {
    const TestDirectory directory;
    struct View {
        const char* camera; // before Camera
        const char* light;  // before LightSource
        glm::dmat4 to_camera, to_world;
    };
    const glm::dmat4 one(1.0);
    const auto turn = [&](double degrees, double x, double y, double z) {
        return glm::rotate(one, glm::radians(degrees), glm::normalize(glm::dvec3(x, y, z)));
    };
    const View views[] = {{"", "", one, one},
                          {"Scale -1 1 1", "", glm::scale(one, {-1, 1, 1}), one},
                          {"", "Rotate -90 1 0 0", one, turn(-90, 1, 0, 0)},
                          {"Scale -1 1 1 Rotate 25 1 2 0", "Rotate -70 1 0.3 0.2",
                           glm::scale(one, {-1, 1, 1}) * turn(25, 1, 2, 0), turn(-70, 1, 0.3, 0.2)},
                          {"Rotate 25 1 2 0", "Scale 1 -1 1 Rotate 40 0 0 1", turn(25, 1, 2, 0),
                           glm::scale(one, {1, -1, 1}) * turn(40, 0, 0, 1)}};
    for (const View& view : views) {
        // The texel nearest to where the camera looks somewhat off its middle.
        const glm::dvec3 wanted = glm::inverse(glm::dmat3(view.to_world)) * glm::inverse(glm::dmat3(view.to_camera)) *
                                  glm::dvec3(0.3, 0.2, 1.0);
        int best = 0;
        const auto direction = [](int texel) {
            return pbrt_direction((texel % map_size + 0.5) / map_size, (texel / map_size + 0.5) / map_size);
        };
        for (int i = 1; i < map_size * map_size; ++i)
            if (glm::dot(direction(i), wanted) > glm::dot(direction(best), wanted))
                best = i;
        write_map(directory.path / "sky.hdr", best % map_size, best / map_size);
        const std::string text = fmt::format("{}\nCamera \"perspective\" \"float fov\" 90\nFilm \"rgb\" \"integer "
                                             "xresolution\" 60 \"integer yresolution\" 40\nSampler \"independent\" "
                                             "\"integer pixelsamples\" 16\nPixelFilter \"box\"\nWorldBegin\n{}\n"
                                             "LightSource \"infinite\" \"string filename\" \"sky.hdr\"\n",
                                             view.camera, view.light);
        const std::filesystem::path file = directory.path / "s.pbrt";
        const Scene scene = parse_scene(translate_pbrt(read_pbrt(text, file)), file);
        const glm::dvec3 seen = glm::dmat3(view.to_camera) * (glm::dmat3(view.to_world) * direction(best));
        CAPTURE(text);
        const glm::dvec2 here = brightest(render_here(scene, 1).film);
        CHECK(here.x == Approx(30.0 + 20.0 * seen.x / seen.z).margin(0.7)); // texels are of some 3 pixels
        CHECK(here.y == Approx(20.0 - 20.0 * seen.y / seen.z).margin(0.7));
    }
}

TEST_CASE("a converted pbrt scene is the picture of the pbrt scene, bit for bit", "[gpu][pbrt]") {
    const Folder folder("");
    std::filesystem::create_directories(folder.file("in"));
    std::filesystem::create_directories(folder.file("out"));
    folder.write("in/a.pbrt", ball + "Material \"diffuse\" MediumInterface \"\" Include \"floor.pbrt\"\n");
    folder.write("in/floor.pbrt", "Shape \"plymesh\" \"string filename\" \"$floor.ply\"\n");
    folder.write("in/$floor.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                 "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n-9 -1 -9\n"
                 "9 -1 -9\n0 -1 9\n3 0 1 2\n");
    CHECK(folder.script("\"$vkvol\" convert in/a.pbrt -o /dev/stdout 2>/dev/null | tail -c 11").text == "</options>\n");
    // Wherever that text comes to be, its files are where they were.
    CHECK(
        folder
            .script(
                "\"$vkvol\" convert in/a.pbrt -o /dev/stdout 2>/dev/null > out/c.xml; \"$vkvol\" out/c.xml -q -o c.exr")
            .code == exit_done);
    const Run converted = folder.vkvol("convert in/a.pbrt -o out/b.xml");
    CHECK(converted.text == "out/b.xml: 1 media, 1 lights, 1 surfaces\n");
    REQUIRE(folder.vkvol("in/a.pbrt -q -o a.exr").code == exit_done);
    REQUIRE(folder.vkvol("out/b.xml -q -o b.exr").code == exit_done);
    CHECK(same_bits(read_exr(folder.file("a.exr")), read_exr(folder.file("b.exr"))));
    // What it makes is a scene like others.
    CHECK(folder.script("xmllint --noout --schema " VKVOL_SOURCE_DIR "/scenes/vkvol.xsd out/b.xml || test $? = 127")
              .code == 0);
}

TEST_CASE("all of scenes/pbrt is rendered, and converted to the same bits", "[gpu][pbrt][long]") {
    const Folder folder("");
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(VKVOL_SOURCE_DIR "/scenes/pbrt"))
        if (entry.path().extension() == ".pbrt" && entry.path().stem() != "cloud") // which needs a grid that is made
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& path : in_turn(files, 2)) {
        const std::string file = path.string();
        CAPTURE(file);
        const Run run = folder.vkvol(file + " --width 40 --spp 2 -o a.exr");
        CHECK(run.code == exit_done);
        REQUIRE(folder.vkvol("convert " + file + " -q --strict -o b.xml").code == exit_done); // all of each
        REQUIRE(folder.vkvol("convert " + file + " -q -o b.xml").code == exit_done);
        REQUIRE(folder.vkvol("b.xml --width 40 --spp 2 -q -o b.exr").code == exit_done);
        CHECK(same_bits(read_exr(folder.file("a.exr")), read_exr(folder.file("b.exr"))));
    }
}

TEST_CASE("pbrt scenes on the command line", "[gpu][pbrt][long]") {
    const Folder folder("");
    folder.write("a.pbrt", ball);
    folder.write("b.pbrt", ball + "Material \"diffuse\" MediumInterface \"\"\nShape \"curve\"\n");
    const auto refused = [&](const std::string& arguments, const char* why) {
        const Run run = folder.vkvol(arguments);
        CAPTURE(arguments);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Catch::StartsWith("vkvol: error: ") && Contains(why));
    };
    CHECK_THAT(folder.vkvol("b.pbrt -o b.exr").text,
               Contains("vkvol: warning: b.pbrt:13:1: Shape \"curve\" is left out"));
    refused("b.pbrt --strict -o b.exr", "b.pbrt:13:1: Shape \"curve\" is left out (under --strict)");
    CHECK(folder.vkvol("a.pbrt --strict -q -o a.exr").code == exit_done);
    refused("a.pbrt -D a=b -o a.exr", "-D and -f fill in the $keys");
    refused("convert a.pbrt", "a scene and an output are needed");
    refused("convert ball.xml -o b.xml", "convert reads scenes of pbrt-v4; expected .pbrt");
    refused("convert a.pbrt -o a.pbrt", "expected .xml");
    refused("convert b.pbrt --strict -o b.xml", "(under --strict)");
    CHECK_FALSE(std::filesystem::exists(folder.file("b.xml")));
    refused("convert none.pbrt -o b.xml", "none.pbrt: no such file");
    // Densities get files that nobody has named: nothing is written over, but by what is the same.
    folder.write("g.pbrt",
                 "WorldBegin LightSource \"infinite\" MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float "
                 "density\" 1\nMediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\"\n");
    folder.write("g_m.nvdb", "mine");
    refused("convert g.pbrt -o g.xml", "g_m.nvdb: is there already");
    std::filesystem::create_directories(folder.file("f_m.nvdb"));
    refused("convert g.pbrt -o f.xml", "f_m.nvdb: is there already");
    CHECK_FALSE(std::filesystem::exists(folder.file("g.xml")));
    CHECK(folder.vkvol("convert g.pbrt -q -o h.xml").code == exit_done);
    CHECK(folder.vkvol("convert g.pbrt -q -o h.xml").code == exit_done);
    CHECK(folder.vkvol("convert g.pbrt -q -o ' odd name.xml'").code == exit_done);
    CHECK(folder.vkvol("' odd name.xml' --width 4 --height 4 -q -o odd.exr").code == exit_done);
}

TEST_CASE("where a converted scene cannot be is said", "[gpu][pbrt]") {
    const Folder folder("");
    folder.write("a.pbrt", ball);
    for (const char* place : {"none/b.xml", "folder.xml"}) {
        std::filesystem::create_directories(folder.file("folder.xml"));
        const Run run = folder.vkvol(std::string("convert a.pbrt -o ") + place);
        INFO(run.text);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains("directory"));
    }
}
