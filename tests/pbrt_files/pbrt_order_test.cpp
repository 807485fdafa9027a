// What pbrt refuses in the order of a file's directives, and which media its camera and shapes that nothing meets have.
#include <algorithm>

#include "pbrt_scenes.h"
#include "support/test_directory.h"

using namespace vkvol;
using Catch::Contains;

namespace {

const std::string own_fog = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" ";
const std::string whole_ball = " Shape \"sphere\" ";

void is_refused(const std::string& text, const std::string& expected) {
    CAPTURE(text);
    CHECK_THROWS_WITH(scene_of(text), Contains(expected));
}

bool notes(const Scene& scene, const std::string& part) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& warning) { return warning.find(part) != warning.npos; });
}

// The corners of a cube about `x` 0 0, with all faces as seen from outside.
std::string cube(double x) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 8; ++i)
        text += fmt::format("{} {} {}\n", x + (i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2) - 0.5);
    return text + "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
}

} // namespace

TEST_CASE("blocks of pbrt end by what began them", "[cpu][pbrt]") {
    is_refused("WorldBegin ObjectBegin \"o\"" + whole_ball + "AttributeEnd",
               "AttributeEnd, but what s.pbrt:1:12 begins");
    is_refused("WorldBegin ObjectBegin \"o\" AttributeBegin" + whole_ball + "ObjectEnd AttributeEnd",
               "ObjectEnd, but what s.pbrt:1:28 begins");
    const TestDirectory directory;
    directory.write("object.inc", "ObjectBegin \"o\"" + whole_ball);
    directory.write("block.inc", "\nAttributeBegin" + whole_ball);
    const auto imported = [&](const std::string& text) {
        return read_pbrt("WorldBegin " + text, directory.path / "s.pbrt");
    };
    CHECK_THROWS_WITH(imported("Import \"object.inc\"" + whole_ball),
                      Contains("object.inc:1:1: ObjectBegin \"o\" lacks"));
    CHECK_THROWS_WITH(imported("Import \"object.inc\""), Contains("object.inc:1:1: ObjectBegin \"o\" lacks"));
    CHECK_THROWS_WITH(imported("Import \"block.inc\"" + whole_ball),
                      Contains("block.inc:2:1: an AttributeBegin lacks"));
    CHECK_THROWS_WITH(imported("ObjectBegin \"o\" Import \"block.inc\" ObjectEnd"), Contains("block.inc:2:1: an Attr"));
}

TEST_CASE("what is pbrt's world comes behind WorldBegin, and under one name once", "[cpu][pbrt]") {
    for (const char* directive : {"Shape", "LightSource", "Material", "AreaLightSource", "AttributeBegin", "Import",
                                  "Texture", "ReverseOrientation", "ObjectBegin", "TransformBegin"})
        is_refused(std::string(directive) + " \"a\" WorldBegin", std::string(directive) + " belongs behind WorldBegin");
    is_refused("WorldBegin " + own_fog + own_fog, "a second medium \"fog\"");
    const std::string made = " MakeNamedMaterial \"m\" \"string type\" \"diffuse\"",
                      texture = " Texture \"t\" \"spectrum\" \"constant\"";
    is_refused("WorldBegin" + made + made, "a second material \"m\"");
    is_refused("WorldBegin" + texture + texture, "a second texture \"t\"");
}

TEST_CASE("pbrt's shapes of alpha 0 bound no media, and its clouds are not scaled", "[cpu][pbrt]") {
    const std::string within = own_fog + "MediumInterface \"fog\" \"\" Material \"interface\"" + whole_ball;
    CHECK(world_of(within).volumes.size() == 1);
    CHECK(world_of(within + "\"float alpha\" 0").volumes.empty());
    CHECK(world_of(within + "\"float alpha\" 0").warnings.empty());
    CHECK(world_of(within + "\"float alpha\" .5").volumes.size() == 1);
    const Scene cloud = world_of("Attribute \"medium\" \"float scale\" 10 MakeNamedMedium \"c\" \"string type\" "
                                 "\"cloud\" MediumInterface \"c\" \"\" Material \"interface\"" +
                                 whole_ball);
    REQUIRE(cloud.volumes.size() == 1);
    CHECK(near(cloud.volumes[0].sigma_s, glm::dvec3(1.0)));
}

TEST_CASE("the fog that pbrt's camera is in ends where a shape about the camera ends it", "[cpu][pbrt]") {
    const TestDirectory directory;
    directory.write("far.ply", cube(4.0));
    directory.write("about.ply", cube(0.2));
    const auto seen = [&](const std::string& before, const std::string& world) {
        const std::string text = own_fog + before + "Camera \"perspective\" WorldBegin " + world;
        const std::filesystem::path file = directory.path / "s.pbrt";
        return parse_scene(translate_pbrt(read_pbrt(text, file)), file.string());
    };
    const auto is_everywhere = [](const Scene& scene) {
        return std::any_of(scene.volumes.begin(), scene.volumes.end(),
                           [](const Volume& volume) { return std::holds_alternative<Everywhere>(volume.shape); });
    };
    const std::string around = "MediumInterface \"\" \"fog\" ", mesh = "Shape \"plymesh\" \"string filename\" ";
    CHECK(is_everywhere(seen(around, "ReverseOrientation " + mesh + "\"far.ply\"")));
    CHECK(!is_everywhere(seen(around, "ReverseOrientation " + mesh + "\"about.ply\"")));
    // Rays begin in what the camera is said to be in, wherever it is: not so here.
    const std::string inside = "MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"";
    CHECK(notes(seen("", inside), "the camera is within medium \"fog\", and so are its rays; pbrt's begin in none"));
    CHECK(!notes(seen("Translate 3 0 0 ", inside), "the camera is within"));
    CHECK(!notes(seen(around, inside), "the camera is within"));
    // What ends it for pbrt's rays alone.
    const std::string juice =
        "MakeNamedMedium \"j\" \"string type\" \"homogeneous\" MediumInterface \"j\" \"\" Material "
        "\"interface\" Translate 0 0 9 Shape \"sphere\"";
    CHECK(notes(seen(around, juice), "medium \"fog\" goes on beyond this; pbrt's rays leave it here"));
    CHECK(!notes(seen("", juice), "goes on beyond this"));
    CHECK(!notes(seen(around, "ReverseOrientation " + mesh + "\"about.ply\" " + juice), "goes on beyond this"));
}

TEST_CASE("the mesh about pbrt's camera is found wherever the converted scene is", "[cpu][pbrt]") {
    const TestDirectory directory;
    directory.write("about.ply", cube(0.2));
    const PbrtScene pbrt = read_pbrt(own_fog + "MediumInterface \"\" \"fog\" Camera \"perspective\" WorldBegin "
                                               "ReverseOrientation Shape \"plymesh\" \"string filename\" \"about.ply\"",
                                     directory.path / "s.pbrt");
    PbrtTranslationOptions beside_another;
    beside_another.name_of_file = [](const std::string& name) { return "elsewhere/" + name; };
    const std::string xml = translate_pbrt(pbrt, beside_another).xml;
    CHECK_THAT(xml, Contains("elsewhere/about.ply") && !Contains("<everywhere"));
}

TEST_CASE("what is wrong with pbrt's media and shutters has their places", "[cpu][pbrt]") {
    is_refused(
        "WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float g\" 1.5\nMaterial \"interface\" "
        "MediumInterface \"m\" \"\"\nShape \"sphere\"",
        "s.pbrt:2:1: ");
    is_refused("Film \"rgb\"\nCamera \"perspective\" \"float shutteropen\" 2 \"float shutterclose\" 1 WorldBegin",
               "s.pbrt:2:1: an exposure of 0; expected a shutter");
}

TEST_CASE("what is pbrt's options comes before WorldBegin, and numbers' textures are of one name, too", "[cpu][pbrt]") {
    is_refused("WorldBegin\nTransformTimes 0 1", "s.pbrt:2:1: TransformTimes belongs before WorldBegin");
    is_refused("WorldBegin\nAccelerator \"bvh\"", "s.pbrt:2:1: Accelerator belongs before WorldBegin");
    const std::string number = "Texture \"t\" \"float\" \"constant\" ";
    is_refused("WorldBegin " + number + number, "a second texture \"t\"");
    CHECK(world_of(number + "Texture \"t\" \"spectrum\" \"constant\"" + whole_ball).surfaces.size() == 1);
}
