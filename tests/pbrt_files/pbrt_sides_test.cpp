// Which side of a pbrt shape has which medium, what of it is not rendered, and what files and blocks leave behind.
#include <algorithm>
#include <fmt/format.h>

#include "pbrt_scenes.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_directory.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

const std::string media = "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 1 1 ]\n"
                          "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 2 2 2 ]\n"
                          "Material \"interface\" ";
const std::string sided_ball = " Shape \"sphere\" ";
// Its points go round as seen from outside.
const std::string box =
    " Shape \"trianglemesh\" \"point3 P\" [ -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1 ]"
    " \"integer indices\" [ 0 2 1 0 3 2  5 7 4 5 6 7  4 3 0 4 7 3  1 6 5 1 2 6  3 6 2 3 7 6  4 1 5 4 0 1 ] ";

// sigma_a of the volumes, in their order.
std::vector<double> absorbs(const std::string& text) {
    std::vector<double> all;
    for (const Volume& volume : world_of(media + text).volumes)
        all.push_back(volume.sigma_a.x);
    return all;
}

void check_noted(const std::string& text, const std::string& expected) {
    const Scene scene = world_of(media + text);
    CAPTURE(text, expected);
    CHECK(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                        [&](const std::string& warning) { return warning.find(expected) != warning.npos; }) == 1);
}

} // namespace

TEST_CASE("pbrt's normals say which medium is within", "[cpu][pbrt]") {
    using All = std::vector<double>;
    CHECK(absorbs("MediumInterface \"a\" \"\"" + sided_ball) == All{1});
    CHECK(absorbs("ReverseOrientation MediumInterface \"\" \"a\"" + sided_ball) == All{1});
    CHECK(absorbs("ReverseOrientation Scale -1 1 1 MediumInterface \"a\" \"\"" + sided_ball) ==
          All{1}); // a mirror turns a ball about,
    CHECK(absorbs("Scale -1 1 1 MediumInterface \"\" \"a\"" + sided_ball) == All{1});
    CHECK(absorbs("Scale -1 1 1 MediumInterface \"a\" \"\"" + box) == All{1}); // and no triangles
    CHECK(absorbs("MediumInterface \"a\" \"\"" + box) == All{1});
    CHECK(absorbs("ReverseOrientation MediumInterface \"\" \"a\"" + box) == All{1});
    CHECK(absorbs("MediumInterface \"b\" \"a\"" + sided_ball + "MediumInterface \"a\" \"\" Scale 3 3 3" + sided_ball) ==
          All{2, 1});
    CHECK(absorbs("ReverseOrientation MediumInterface \"a\" \"\"" + sided_ball).empty());
    // An instance carries normals along, whatever it does to space.
    const auto object = [](const std::string& text) {
        return "ObjectBegin \"o\" MediumInterface \"a\" \"\" " + text + " ObjectEnd Scale -1 1 1 ObjectInstance \"o\"";
    };
    CHECK(absorbs(object(sided_ball)) == All{1});
    CHECK(absorbs(object("Scale -1 1 1" + sided_ball)).empty());
    CHECK(absorbs(object(box)) == All{1});
}

// Of what is flat the volume is rounding, of either sign.
TEST_CASE("pbrt's panes of glass have their inside below them however they are turned", "[cpu][pbrt]") {
    const std::string pane =
        " Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ] \"integer indices\" ";
    for (const char* order : {"[ 0 1 2 1 3 2 ]", "[ 0 1 2 2 1 3 ]"})
        for (int degrees = 1; degrees < 90; ++degrees) {
            const Scene scene =
                world_of(fmt::format("Material \"dielectric\" Rotate {} 1 2 3", degrees) + pane + order);
            CAPTURE(order, degrees);
            REQUIRE(scene.surfaces.size() == 1);
            CHECK(scene.surfaces.front().material.ior == 1.5);
        }
    // Points of six digits.
    CHECK(world_of("Material \"dielectric\" Shape \"trianglemesh\" \"point3 P\" [ 2.12846 -0.327634 2.30894 4.12733 "
                   "-0.271496 2.27189 "
                   "2.07267 1.6715 2.32811 4.07154 1.72763 2.29106 ] \"integer indices\" [ 0 1 2 1 3 2 ]")
              .surfaces.at(0)
              .material.ior == 1.5);
}

TEST_CASE("pbrt's panes with normals, and flat shapes of other kinds, have their inside below them, too",
          "[cpu][pbrt]") {
    const std::string corners = " Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ] ";
    const std::string pane = corners + "\"integer indices\" [ 0 1 2 1 3 2 ] ";
    const std::string normals = "\"normal N\" [ 0 0 1 0 0 1 0 0 1 0 0 1 ] ";
    const std::string six = " Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 0 2 0 ] "
                            "\"integer indices\" [ 0 1 2 1 3 2 2 3 4 ] ";
    for (const std::string& flat : {pane + normals, six})
        for (int degrees = 1; degrees < 90; ++degrees) {
            const Scene scene = world_of(fmt::format("Material \"dielectric\" Rotate {} 1 2 3", degrees) + flat);
            CAPTURE(flat, degrees);
            REQUIRE(scene.surfaces.size() == 1);
            CHECK(scene.surfaces.front().material.ior == 1.5);
        }
}

// As pbrt has it for triangles whose normals an exporter wrote as zeros: as if there were none.
TEST_CASE("pbrt's normals of no length turn no triangle", "[cpu][pbrt]") {
    const auto front = [](const std::string& before, const std::string& normals) {
        const Scene scene = world_of(before +
                                     " AreaLightSource \"diffuse\" Shape \"trianglemesh\" \"point3 P\" "
                                     "[ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ] \"integer indices\" [ 0 1 2 1 3 2 ] " +
                                     normals);
        const Surface& lamp = scene.surfaces.at(0);
        const RectangleSurface& shape = std::get<RectangleSurface>(lamp.shape);
        return glm::dmat3(lamp.transform) * glm::cross(shape.edge_u, shape.edge_v);
    };
    for (const std::string before : {"", "ReverseOrientation", "Scale -1 1 1"}) {
        CAPTURE(before);
        CHECK(glm::dot(front(before, ""), front(before, "\"normal N\" [ 0 0 0 0 0 0 0 0 0 0 0 0 ]")) > 0.0);
    }
}

TEST_CASE("pbrt's disks have their front where a mirror puts it", "[cpu][pbrt]") {
    const auto normal = [](const std::string& before) {
        const Surface disk = world_of(before + " Shape \"disk\"").surfaces.at(0);
        return glm::normalize(glm::dmat3(disk.transform) * std::get<DiskSurface>(disk.shape).normal).z;
    };
    const double front = normal("");
    CHECK(std::abs(front) == Approx(1.0));
    CHECK(normal("ReverseOrientation") == Approx(-front));
    CHECK(normal("Scale -1 1 1") == Approx(-front));
    CHECK(normal("ReverseOrientation Scale -1 1 1") == Approx(front));
}

TEST_CASE("pbrt's rough glass that bends next to nothing is smooth, turned inside out or not", "[cpu][pbrt]") {
    for (const char* turned : {"", "ReverseOrientation "})
        for (const char* index : {"1.009", "1.01", "1.0100999"}) {
            const Scene scene =
                world_of(std::string(turned) + R"(Material "dielectric" "float roughness" 0.1 "float eta" )" + index +
                         R"( Shape "sphere")");
            CAPTURE(turned, index);
            CHECK(scene.surfaces.at(0).material.roughness == 0.0);
        }
    CHECK(world_of(R"(Material "dielectric" "float eta" 1.02 "float roughness" 0.1 Shape "sphere")")
              .surfaces.at(0)
              .material.roughness > 0.0);
}

TEST_CASE("pbrt's infinite light with a nameless file is even", "[cpu][pbrt]") {
    const Scene scene = world_of(R"(LightSource "infinite" "string filename" "" "rgb L" [ 0.4 0.45 0.5 ])");
    CHECK(scene.lights.empty());
    CHECK(near(scene.background, {0.4, 0.45, 0.5}));
}

TEST_CASE("pbrt's usual camera is told to be within a medium, too", "[cpu][pbrt]") {
    const std::string fog =
        "WorldBegin MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" AttributeBegin MediumInterface \"fog\" "
        "\"\" Material \"interface\" Shape \"sphere\" \"float radius\" 3 AttributeEnd";
    for (const char* camera : {"", "Camera \"perspective\" "}) {
        const std::vector<std::string> warnings = scene_of(camera + fog).warnings;
        CAPTURE(camera);
        CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& w) {
            return w.find("the camera is within medium") != std::string::npos;
        }));
    }
}

TEST_CASE("pbrt's nameless area light ends what shines, and others are refused", "[cpu][pbrt]") {
    const Scene scene = world_of("AreaLightSource \"diffuse\"" + sided_ball + "AreaLightSource \"\"" + sided_ball);
    REQUIRE(scene.surfaces.size() == 2);
    CHECK(scene.surfaces[0].emission != Rgb(0.0));
    CHECK(scene.surfaces[1].emission == Rgb(0.0));
    CHECK_THROWS_WITH(world_of("AreaLightSource \"spheric\"" + sided_ball), Contains("\"diffuse\" is the only one"));
}

TEST_CASE("pbrt's cropwindow is rounded in single precision", "[cpu][pbrt]") {
    const auto width = [](const char* text) {
        return scene_of("Film \"rgb\" " + std::string(text) + " Camera \"perspective\" WorldBegin " + sided_ball)
            .picture.width;
    };
    CHECK(width("\"integer xresolution\" 800 \"float cropwindow\" [ .3 .6 0 1 ]") == 480 - 240);
    CHECK(width("\"integer xresolution\" 100 \"float cropwindow\" [ 0 .55 0 1 ]") == 55);
}

TEST_CASE("pbrt's media that are not rendered as in pbrt are named", "[cpu][pbrt]") {
    check_noted("ReverseOrientation MediumInterface \"a\" \"\"" + sided_ball,
                "medium \"a\" is outside of this, as its normals point");
    check_noted("MediumInterface \"b\" \"a\"" + sided_ball + "MediumInterface \"a\" \"\" Scale 3 3 3" + sided_ball,
                "medium \"a\" goes on within");
    check_noted(
        "MakeNamedMaterial \"g\" \"string type\" \"dielectric\" NamedMaterial \"g\" MediumInterface \"b\" \"a\"" +
            sided_ball + "Material \"interface\" MediumInterface \"a\" \"\" Scale 3 3 3" + sided_ball,
        "medium \"a\" goes on within");
    CHECK(scene_of("Integrator \"path\" Translate 3 0 0 Camera \"perspective\" WorldBegin " + media +
                   "MediumInterface \"a\" \"\"" + sided_ball)
              .warnings.size() == 1);
    check_noted("MediumInterface \"a\" \"\" Shape \"sphere\" \"float zmax\" 0",
                "\"sphere\" encloses medium \"a\", which is left out");
    check_noted("MediumInterface \"a\" \"\" Shape \"plymesh\" \"string filename\" \"a.ply\"" + sided_ball,
                "\"plymesh\" encloses medium \"a\", which is left out");
    const std::string grid =
        "MakeNamedMedium \"g\" \"string type\" \"uniformgrid\" \"integer nx\" 1 \"integer ny\" 1 \"integer nz\" 1 "
        "\"float density\" [ 0 ] \"point3 p0\" [ -1 -1 -1 ] \"point3 p1\" [ 1 1 1 ] MediumInterface \"g\" \"\" ";
    const std::string not_cut = "the grid of medium \"g\" reaches beyond this";
    check_noted(grid + sided_ball, not_cut);
    check_noted(grid + "Scale .9 2 2" + box, not_cut);
    check_noted(grid + "Shape \"plymesh\" \"string filename\" \"a.ply\"", "the grid of medium \"g\" fills its box");
    check_noted(grid + "MediumInterface \"\" \"g\"" + sided_ball, "the grid of medium \"g\" goes on within");
    for (const std::string& whole : {box, "Scale 1.8 1.8 1.8" + sided_ball})
        for (const std::string& warning : world_of(media + grid + whole).warnings)
            CHECK_THAT(warning, !Contains(not_cut));
    const auto fog = [](const std::string& lights) {
        return scene_of("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" MediumInterface \"\" \"a\" Camera "
                        "\"perspective\" WorldBegin " +
                        lights);
    };
    REQUIRE(fog("LightSource \"distant\"").warnings.size() == 1);
    CHECK_THAT(fog("LightSource \"distant\"").warnings[0], Contains("medium \"a\" has no end"));
    CHECK(fog("LightSource \"point\"").warnings.empty());
}

TEST_CASE("a closed mesh of a file holds any of pbrt's media", "[cpu][pbrt]") {
    const TestDirectory directory;
    const std::filesystem::path open = directory.write(
        "open.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
        "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const auto mesh = [](const std::string& file) {
        return " Shape \"plymesh\" \"string filename\" \"" + file + "\" ";
    };
    const std::string closed = "MediumInterface \"a\" \"\"" + mesh(VKVOL_SOURCE_DIR "/tests/pbrt_features/pyramid.ply");
    const std::string ball = "MediumInterface \"b\" \"\"" + sided_ball;
    CHECK(absorbs(closed + ball) == std::vector{1.0, 2.0});
    CHECK(absorbs(closed + closed + ball) == std::vector{1.0, 1.0, 2.0});
    check_noted("MediumInterface \"a\" \"\"" + mesh(open.string()) + ball,
                "\"plymesh\" encloses medium \"a\", which is left out");
}

TEST_CASE("a grid about pbrt's camera is one of its media", "[cpu][pbrt]") {
    const Scene scene = scene_of(
        "MakeNamedMedium \"c\" \"string type\" \"uniformgrid\" \"integer nx\" 1 \"integer ny\" 1 \"integer nz\" 1 "
        "\"float density\" [ 1 ] \"point3 p0\" [ -9 -9 -9 ] \"point3 p1\" [ 9 9 9 ] MediumInterface \"\" \"c\" "
        "Camera \"perspective\" WorldBegin MakeNamedMedium \"a\" \"string type\" \"homogeneous\" "
        "MediumInterface \"a\" \"\" Material \"interface\" Shape \"plymesh\" \"string filename\" \"a.ply\"");
    CHECK(std::any_of(scene.warnings.begin(), scene.warnings.end(), [](const std::string& warning) {
        return warning.find("\"plymesh\" encloses medium \"a\", which is left out") != std::string::npos;
    }));
}

TEST_CASE("images of pbrt's textures that are taken otherwise are named", "[cpu][pbrt]") {
    const auto check = [](const std::string& parameter, const std::string& expected) {
        check_noted("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" " + parameter +
                        " Material \"diffuse\" \"texture reflectance\" \"t\"" + sided_ball,
                    expected);
    };
    check("\"float scale\" 3", "taken 3 times, and once here");
    check("\"string wrap\" \"black\"", "the image is repeated");
    check("\"string encoding\" \"linear\"", "encoding \"linear\" is left out");
    check("\"float uscale\" -1", "mirrors no image of such a shape here");
    check("\"string mapping\" \"planar\"", "mapping \"planar\" is left out");
    for (const char* usual : {"\"string mapping\" \"uv\"", "\"float uscale\" 2"})
        CHECK(world_of(std::string("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" ") + usual +
                       " Material \"diffuse\" \"texture reflectance\" \"t\"" + sided_ball)
                  .warnings.empty());
    // Textures of colours and of numbers may share a name.
    const Scene scene =
        world_of("Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ .8 .1 .1 ] Texture \"t\" \"float\" "
                 "\"constant\" \"float value\" .05 Material \"diffuse\" \"texture reflectance\" \"t\"" +
                 sided_ball);
    CHECK(near(scene.surfaces.at(0).material.color, {.8, .1, .1}));
    CHECK_THROWS_WITH(world_of("Texture \"t\" \"color\" \"constant\""), Contains("expected \"spectrum\" or \"float\""));
}

TEST_CASE("blocks and imported files leave pbrt's state as they find it", "[cpu][pbrt]") {
    const std::string red = "Material \"diffuse\" \"rgb reflectance\" [ .8 .1 .1 ] ",
                      green = "Material \"diffuse\" \"rgb reflectance\" [ .1 .8 .1 ] ";
    const auto colors = [&](const std::string& text, const std::filesystem::path& file = "s.pbrt") {
        const std::string whole = "Camera \"perspective\" WorldBegin " + red + text + sided_ball;
        std::vector<glm::dvec3> all;
        for (const Surface& surface : parse_scene(translate_pbrt(read_pbrt(whole, file)), file.string()).surfaces)
            all.push_back(surface.material.color);
        return all;
    };
    CHECK(near(colors("TransformBegin " + green + "TransformEnd").back(), {.8, .1, .1}));
    const TestDirectory directory;
    directory.write("green.inc", green + sided_ball);
    directory.write("nothing.inc", "# nothing");
    directory.write("nested.inc", "Import \"green.inc\"" + sided_ball);
    directory.write("ends.inc", "AttributeEnd");
    const std::filesystem::path file = directory.path / "s.pbrt";
    const std::vector<glm::dvec3> seen =
        colors("Import \"green.inc\" Import \"nothing.inc\" Import \"nested.inc\"", file);
    REQUIRE(seen.size() == 4);
    CHECK(near(seen[0], {.1, .8, .1}));
    CHECK(near(seen[1], {.1, .8, .1}));
    CHECK(near(seen[2], {.8, .1, .1}));
    CHECK(near(seen[3], {.8, .1, .1}));
    directory.write("plain.inc", green);
    CHECK(near(colors("Include \"plain.inc\"", file).back(), {.1, .8, .1}));
    directory.write("open.inc", "AttributeBegin");
    CHECK_THROWS_WITH(colors("Include \"open.inc\"", file), Contains("an AttributeBegin lacks its AttributeEnd"));
    // Coordinate systems are a file's own.
    directory.write("system.inc", "CoordSysTransform \"far\"" + sided_ball);
    const std::string whole =
        "Camera \"perspective\" WorldBegin AttributeBegin Translate 9 0 0 CoordinateSystem \"far\" "
        "AttributeEnd Import \"system.inc\" CoordSysTransform \"far\"" +
        sided_ball;
    const Scene systems = parse_scene(translate_pbrt(read_pbrt(whole, file)), file.string());
    REQUIRE(systems.surfaces.size() == 2);
    CHECK(near(std::get<BallSurface>(systems.surfaces[0].shape).center, {0, 0, 0}));
    CHECK(near(std::get<BallSurface>(systems.surfaces[1].shape).center, {9, 0, 0}));
    CHECK_THROWS_WITH(colors("AttributeBegin Import \"ends.inc\"", file),
                      Contains("ends.inc:1:1: AttributeEnd without what it ends"));
}

TEST_CASE("pbrt's names of media, spectra and spaces", "[cpu][pbrt]") {
    const auto preset = [](const std::string& name) {
        return world_of("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"string preset\" \"" + name +
                        "\" MediumInterface \"m\" \"\" Material \"interface\"" + sided_ball)
            .volumes.at(0)
            .sigma_a;
    };
    CHECK(near(preset("Coke"), {.10014, .16503, .2468}));
    CHECK_THROWS_WITH(preset("Cokes"), Contains("did you mean Coke?"));
    CHECK(world_of("Material \"dielectric\" \"spectrum eta\" \"glass-F11\"" + sided_ball).surfaces.at(0).material.ior ==
          Approx(1.7847));
    CHECK(world_of("Material \"conductor\" \"spectrum eta\" \"metal-TiO2-eta\" \"spectrum k\" \"metal-TiO2-k\"" +
                   sided_ball)
              .warnings.empty());
    CHECK(world_of("ColorSpace \"sRGB\" LightSource \"point\"").warnings.empty());
    // Colours of an Attribute are of the space at its place.
    const Scene scene =
        world_of("Attribute \"light\" \"rgb I\" [ 1 0 0 ] ColorSpace \"rec2020\" LightSource \"point\"");
    CHECK(near(only_light<PointLight>(scene).intensity, {1, 0, 0}));
    // Light of ACES's space is times its illuminant, D60: its chromaticity (0.32168, 0.33767) as Rec.709 of
    // luminance 1.
    for (const char* light : {"LightSource \"point\"", "LightSource \"point\" \"rgb I\" [ 1 1 1 ]"})
        CHECK(near(only_light<PointLight>(world_of(std::string("ColorSpace \"aces2065-1\" ") + light)).intensity,
                   {1.0470, .9946, .9155}, 1e-3));
    CHECK(near(world_of("ColorSpace \"aces2065-1\" Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]" + sided_ball)
                   .surfaces.at(0)
                   .material.color,
               glm::dvec3(.5), 1e-4));
    CHECK(world_of("CoordSysTransform \"none\" LightSource \"point\"").warnings.size() == 1);
    CHECK(scene_of("Sampler \"independent\" Camera \"perspective\" WorldBegin").settings.spp == 4);
    CHECK(scene_of("Sampler \"zsobol\" Camera \"perspective\" WorldBegin").settings.spp == 16);
    CHECK_THROWS_WITH(world_of("LightSource \"infinite\" \"string filename\" \"a.exr.gz\""),
                      Contains("unpack it with gunzip"));
}

TEST_CASE("grids that pbrt makes before its camera stand about the camera's eye", "[cpu][pbrt]") {
    const std::string grid = "MakeNamedMedium \"c\" \"string type\" \"uniformgrid\" \"integer nx\" 1 \"integer ny\" 1 "
                             "\"integer nz\" 1 \"float density\" [ 1 ] ",
                      camera = "LookAt 1 2 -5  0 0 0  0 1 0 Camera \"perspective\" ",
                      ball = "MediumInterface \"c\" \"\" Material \"interface\" Shape \"sphere\" \"float radius\" 9 ";
    const auto place = [&](const std::string& before, const std::string& after) {
        return scene_of(before + camera + "WorldBegin AttributeBegin " + after + " AttributeEnd " + ball)
            .volumes.at(0)
            .transform;
    };
    const auto same = [](const glm::dmat4& a, const glm::dmat4& b) {
        double most = 0.0;
        for (int i = 0; i < 4; ++i)
            most = std::max(most, glm::length(a[i] - b[i]));
        return most < 1e-6;
    };
    const std::string moved = "Translate 0 0 3 ", back = "Translate 0 0 -3 ";
    CHECK(same(place(moved + grid + back, ""), place("", "Translate 1 2 -2 " + grid)));
    CHECK(
        same(place("Option \"string rendercoordsys\" \"world\" " + moved + grid + back, ""), place("", moved + grid)));
    CHECK(same(place("Option \"string Render-Coord_Sys\" \"world\" " + moved + grid + back, ""),
               place("", moved + grid)));
    CHECK(same(place("Option \"string rendercoordsys\" \"camera\" " + moved + grid + back, ""),
               place("", "CoordSysTransform \"camera\" " + moved + grid)));
}

TEST_CASE("where pbrt's rays leave media that go on here is noted", "[cpu][pbrt]") {
    const std::string fog = "MediumInterface \"a\" \"\" Shape \"sphere\" \"float radius\" 10 ",
                      smoke = "MediumInterface \"b\" \"\" Shape \"sphere\" ";
    check_noted(fog + smoke, "medium \"a\" goes on within and beyond this");
    CHECK(world_of(media + "AttributeBegin Translate 30 0 0 MediumInterface \"a\" \"\" Shape \"sphere\" AttributeEnd " +
                   smoke)
              .warnings.size() == world_of(media + smoke).warnings.size());
    const std::string grid =
        "MakeNamedMedium \"g\" \"string type\" \"uniformgrid\" \"integer nx\" 1 \"integer ny\" 1 "
        "\"integer nz\" 1 \"float density\" [ 1 ] \"point3 p0\" [ -9 -9 -9 ] \"point3 p1\" [ 9 9 9 ] "
        "MediumInterface \"g\" \"\" ";
    check_noted(grid + "Shape \"sphere\" \"float radius\" 20 ", "sees the grid of medium \"g\"");
    check_noted(
        "LightSource \"spot\" \"point3 to\" [ 1 0 1 ] AttributeBegin Scale 1 1 3 LightSource \"spot\" AttributeEnd ",
        "stretched by its transform");
    check_noted("Attribute \"texture\" \"bool invert\" true Texture \"t\" \"spectrum\" \"imagemap\" \"string "
                "filename\" \"a.png\" Material \"diffuse\" \"texture reflectance\" \"t\"" +
                    sided_ball,
                "\"invert\" is left out");
    CHECK(world_of(media + "MediumInterface \"a\" \"\" Translate 9 0 0 Shape \"sphere\" \"float alpha\" 1")
              .warnings.empty());
}

TEST_CASE("fog about pbrt's camera that no shape can end has no end, and is there once", "[cpu][pbrt]") {
    const auto of = [](const std::string& shape) {
        return scene_of("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" MediumInterface \"\" \"a\" Camera "
                        "\"perspective\" WorldBegin MediumInterface \"a\" \"\" Material \"interface\" " +
                        shape);
    };
    const auto has = [](const Scene& scene, const std::string& words) {
        return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                           [&](const std::string& warning) { return warning.find(words) != warning.npos; });
    };
    const Scene cylinder = of("Shape \"cylinder\" \"float radius\" 5");
    CHECK(cylinder.volumes.size() == 1);
    CHECK(has(cylinder, "\"cylinder\" encloses medium \"a\", which has no end here"));
    CHECK(!has(cylinder, "which is left out"));
    const Scene aside = of("Translate 9 0 0 Shape \"sphere\"");
    CHECK(aside.volumes.size() == 1);
    CHECK(has(aside, "is everywhere here, and not twice within this"));
}
