// Scenes of pbrt-v4: what their directives become. What pbrt itself would do is written out here from its book and
// manual (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition; pbrt.org/fileformat-v4).
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "blackbody.h"
#include "pbrt_scenes.h"
#include "pbrt_triangles.h"
#include "support/scenes.h"
#include "surface_mesh.h"

using namespace vkvol;
using Catch::Contains;
using std::numbers::pi;

TEST_CASE("pbrt's lights shine as pbrt's do", "[cpu][pbrt]") {
    CHECK(near(only_light<PointLight>(world_of(R"(LightSource "point" "rgb I" [ 1 2 3 ] "float scale" 2)")).intensity,
               {2, 4, 6}));
    CHECK(near(only_light<PointLight>(world_of(R"(LightSource "point" "float power" 100)")).intensity,
               glm::dvec3(100.0 / (4.0 * pi))));
    // Everything but colours has luminance 1.
    CHECK(near(only_light<PointLight>(world_of(R"(LightSource "point" "blackbody I" 3000)")).intensity,
               blackbody_rgb(3000.0, 3000.0)));
    const glm::dvec3 even =
        only_light<PointLight>(world_of(R"(LightSource "point" "spectrum I" [ 200 7 900 7 ])")).intensity;
    CHECK(near(even, {1.2048, 0.9483, 0.9088}, 6e-3)); // illuminant E in Rec.709; the fit is good to half a percent
    CHECK(near(only_light<PointLight>(world_of(R"(LightSource "point" "spectrum I" "stdillum-D65")")).intensity,
               glm::dvec3(1.0)));

    const auto spot = only_light<SpotLight>(world_of(
        R"(Translate 1 2 3 LightSource "spot" "rgb I" [ 3 3 3 ] "float coneangle" 40 "float conedeltaangle" 10
           "point3 from" [ 1 0 0 ] "point3 to" [ 1 -1 0 ])"));
    CHECK(near(spot.position, {2, 2, -3}));
    CHECK(near(spot.direction, {0, -1, 0}));
    CHECK(spot.angle == Approx(80.0));
    CHECK(spot.blend == Approx(0.25));
    const auto powerful = only_light<SpotLight>(
        world_of(R"(LightSource "spot" "float power" 5 "float coneangle" 40 "float conedeltaangle" 10)"));
    CHECK(power_per_unit(powerful) * powerful.intensity.x == Approx(5.0).epsilon(0.02)); // its rim counts by half

    // A rim wider than the cone goes past the axis, and counts as far again on its other side.
    const auto narrow = only_light<SpotLight>(world_of(R"(LightSource "spot" "float coneangle" 4)"));
    CHECK(narrow.angle == Approx(8.0));
    CHECK(narrow.blend == Approx(0.75));

    const auto distant = only_light<DirectionalLight>(world_of(
        R"(LightSource "distant" "rgb L" [ 1 1 1 ] "float illuminance" 7 "point3 from" [ 1 1 1 ] "point3 to" [ 0 0 1 ])"));
    CHECK(near(distant.direction, glm::normalize(glm::dvec3(1, 1, 0))));
    CHECK(near(distant.irradiance, glm::dvec3(7.0)));

    // Several skies without a map add up; one of given illuminance is that over pi.
    const Scene skies = world_of(R"(LightSource "infinite" "rgb L" [ 1 0 0 ]
                                    LightSource "infinite" "rgb L" [ 0 1 0 ] "float illuminance" 9)");
    CHECK(near(skies.background, {1.0, 9.0 / pi, 0.0}));

    // A map adds up to what pbrt adds up: an even one to pi / 2 times its radiance, half of what it sends there.
    const auto sky_of = [](const std::filesystem::path& map) {
        return only_light<SkyLight>(world_of("LightSource \"infinite\" \"float scale\" 3 \"float illuminance\" 5 "
                                             "\"string filename\" \"" +
                                             map.string() + "\""));
    };
    constexpr int n = 64;
    const RadianceMap day{n, n, std::vector<glm::vec3>(n * n, glm::vec3(0.25f)), 0};
    CHECK(sky_of(write_sky(day).file).scale.x == Approx(3.0 * 5.0 / (0.25 * pi / 2.0)).epsilon(1e-3));
    RadianceMap night = day; // bright below alone, beyond the inner square
    for (int i = 0; i < n * n; ++i)
        if (std::abs(2 * (i % n) + 1 - n) + std::abs(2 * (i / n) + 1 - n) < n)
            night.texels[std::size_t(i)] = glm::vec3(0.0f);
    CHECK_THROWS_WITH(sky_of(write_sky(night).file), Contains("s.pbrt:3:1") && Contains("black"));
    CHECK_THROWS_WITH(sky_of("none.exr"), Contains("s.pbrt:3:1") && Contains("none.exr"));

    const Scene wide =
        scene_of("ColorSpace \"rec2020\"\nCamera \"perspective\"\nWorldBegin\n"
                 "LightSource \"point\" \"rgb I\" [ 1 1 1 ]\nLightSource \"point\" \"rgb I\" [ 0.6274 0.0691 "
                 "0.0164 ]");
    CHECK(near(std::get<PointLight>(wide.lights[0]).intensity, glm::dvec3(1.0), 1e-3));
    CHECK(near(std::get<PointLight>(wide.lights[1]).intensity, {1, 0, 0}, 2e-3)); // red of Rec.709, by ITU-R BT.2087
}

TEST_CASE("what shines in pbrt's scenes", "[cpu][pbrt]") {
    const auto lamp = [](const std::string& text) {
        const Scene scene = world_of("AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] " + text);
        REQUIRE(scene.surfaces.size() == 1);
        return scene.surfaces[0];
    };
    // A rectangle of 3 by 2, in the order that has its front towards -z of pbrt, which is +z here.
    const char* quad = R"("point3 P" [ 0 0 0  0 2 0  3 2 0  3 0 0 ] "integer indices" [ 0 1 2 0 2 3 ])";
    const Surface front = lamp(std::string("Shape \"trianglemesh\" ") + quad);
    const auto& rectangle = std::get<RectangleSurface>(front.shape);
    CHECK(near(front.emission, {1, 2, 3}));
    CHECK(near(rectangle.center, {1.5, 1.0, 0.0}));
    CHECK(near(glm::normalize(glm::cross(rectangle.edge_u, rectangle.edge_v)), {0, 0, 1}));
    CHECK(glm::length(rectangle.edge_u) * glm::length(rectangle.edge_v) == Approx(1.5)); // halves of its edges
    const Surface back = lamp(std::string("ReverseOrientation Shape \"trianglemesh\" ") + quad);
    const auto& turned = std::get<RectangleSurface>(back.shape);
    CHECK(near(glm::normalize(glm::cross(turned.edge_u, turned.edge_v)), {0, 0, -1}));
    // A patch's corners go (0, 0), (1, 0), (0, 1), (1, 1), and its front is where the cross product of its edges
    // points.
    const Surface patch = lamp("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  3 0 0  0 2 0  3 2 0 ]");
    const auto& patched = std::get<RectangleSurface>(patch.shape);
    CHECK(near(glm::normalize(glm::cross(patched.edge_u, patched.edge_v)), {0, 0, -1})); // +z of pbrt

    const auto power = [&](const char* shape, double area) {
        const Surface surface = lamp(std::string("Scale 2 2 2 ") + shape);
        CHECK(surface.emission.x * area * pi == Approx(10.0));
    };
    const std::string watts = R"(AreaLightSource "diffuse" "float power" 10 )";
    power((watts + R"(Shape "sphere" "float radius" 0.5)").c_str(), 4.0 * pi);
    power((watts + R"(Shape "disk" "float radius" 0.5)").c_str(), pi);
    power((watts + R"(Shape "cylinder" "float radius" 0.5)").c_str(),
          8.0 * pi * std::sin(pi / 128.0) * 128.0 / pi);             // of 128 faces
    power((watts + "Shape \"trianglemesh\" " + quad).c_str(), 12.0); // each of two triangles has the power
    power((watts + R"(Shape "bilinearmesh" "point3 P" [ 0 0 0  3 0 0  0 2 0  3 2 0 ])").c_str(), 24.0);
    CHECK(lamp("AreaLightSource \"diffuse\" \"bool twosided\" true Shape \"sphere\"").shines_both_ways);
    CHECK_FALSE(lamp("Shape \"sphere\"").shines_both_ways);
    const Surface disk = lamp("Translate 1 0 0 Rotate 90 1 0 0 Shape \"disk\" \"float height\" 2");
    CHECK(near(std::get<DiskSurface>(disk.shape).normal, {0, -1, 0})); // z of pbrt's disk, turned
    CHECK(near(std::get<DiskSurface>(disk.shape).center, {1, -2, 0}));
}

TEST_CASE("pbrt's materials and textures", "[cpu][pbrt]") {
    const auto material = [](const std::string& text) {
        return world_of(text + "\nShape \"sphere\"").surfaces.at(0).material;
    };
    CHECK(near(material("").color, glm::dvec3(0.5)));
    CHECK(near(material(R"(Material "diffuse" "rgb reflectance" [ .1 .2 .3 ])").color, {.1, .2, .3}));
    CHECK(near(material(R"(Material "diffuse" "spectrum reflectance" [ 300 .25 800 .25 ])").color, glm::dvec3(.25)));
    const Material glass = material(R"(Material "dielectric" "spectrum eta" "glass-BK7" "float roughness" 0.04)");
    CHECK(glass.kind == MaterialKind::dielectric);
    CHECK(glass.ior == Approx(1.5168));
    CHECK(glass.roughness == Approx(0.2)); // alpha is the root
    CHECK(material(R"(Material "dielectric" "float roughness" 0.04 "bool remaproughness" false)").roughness ==
          Approx(0.04));
    CHECK(material(R"(Material "dielectric")").roughness == 0.0);
    // A bubble: its normals say that glass is around it.
    CHECK(material("Material \"dielectric\" ReverseOrientation").ior == Approx(1.0 / 1.5));
    CHECK(material("ReverseOrientation Material \"dielectric\" Scale -1 1 1").ior == Approx(1.5));
    const Material pane = material(R"(Material "thindielectric" "float eta" 1.4)");
    CHECK((pane.kind == MaterialKind::thin_dielectric && pane.ior == 1.4));
    const Material copper = material(R"(Material "conductor")");
    CHECK(near(copper.k, {3.912, 2.452, 2.142}));
    // Fresnel's reflectance at normal incidence is what was asked for.
    const Material grey = material(R"(Material "conductor" "rgb reflectance" [ .3 .5 .9 ])");
    for (int c = 0; c < 3; ++c) {
        const double n = grey.eta[c], k = grey.k[c];
        CHECK(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k) == Approx(c == 0 ? .3 : c == 1 ? .5 : .9));
    }
    const std::string gold = R"(Texture "g" "spectrum" "constant" "rgb value" [ .9 .6 .2 ] )";
    const Material plain = material(R"(Material "conductor" "rgb reflectance" [ .9 .6 .2 ])"),
                   by_texture = material(gold + R"(Material "conductor" "texture reflectance" "g")");
    CHECK((near(plain.k, by_texture.k) && near(plain.eta, by_texture.eta)));
    CHECK(near(material(gold + R"(Material "conductor" "texture eta" "g")").eta, {.9, .6, .2}));
    // What scene files do not take becomes the nearest that they do.
    CHECK(material(R"(Material "conductor" "rgb eta" [ .04 .05 .06 ])").eta.x == Approx(0.05));
    CHECK(material(R"(Material "coateddiffuse" "float eta" .9)").ior == Approx(1.0));
    CHECK(material(R"(Material "dielectric" "float eta" 1 "float roughness" .1)").roughness == 0.0);
    CHECK(material(R"(Texture "r" "float" "constant" Material "coateddiffuse" "texture roughness" "r")").kind ==
          MaterialKind::coated);
    const Material coat = material(R"(Material "coateddiffuse" "float eta" 1.7 "rgb reflectance" [ 1 .5 0 ])");
    CHECK((coat.kind == MaterialKind::coated && coat.ior == Approx(1.7)));

    const Material tiles = material(R"(Texture "t" "spectrum" "imagemap" "string filename" "t.png" "float uscale" 3
        Texture "s" "spectrum" "scale" "texture tex" "t" "float scale" .5
        MakeNamedMaterial "m" "string type" "diffuse" "texture reflectance" "s" NamedMaterial "m")");
    CHECK(tiles.texture.filename() == "t.png");
    CHECK(tiles.repeat == glm::dvec2(3, 1));
    CHECK(near(tiles.color, glm::dvec3(0.5)));

    // The square on the lower left is the first, two of them are a repeat, and colours by textures are as good.
    const auto board_of = [&](const std::string& scales) {
        return material(R"(Texture "a" "spectrum" "constant" "rgb value" [ .8 .4 .2 ]
            Texture "b" "spectrum" "scale" "texture tex" "a" "float scale" .5
            Texture "t" "spectrum" "checkerboard" "texture tex1" "b" "rgb tex2" [ .1 .2 .3 ] )" +
                        scales + R"( Material "diffuse" "texture reflectance" "t")");
    };
    const Material board = board_of(R"("float uscale" 4 "float vscale" 3)");
    REQUIRE(board.image);
    CHECK((board.image->is_nearest && board.image->width == 2 && board.image->height == 2));
    CHECK(near(board.image->colors[2], {.4, .2, .1}, 1e-7));
    CHECK(near(board.image->colors[3], {.1, .2, .3}, 1e-7));
    CHECK(board.repeat == glm::dvec2(2, 1.5));
    CHECK(near(board_of(R"("float uscale" -4)").image->colors[3], {.4, .2, .1}, 1e-7));
    for (const char* odd : {R"("integer dimension" 3)", R"("string mapping" "planar")"})
        CHECK_FALSE(board_of(odd).image);

    // Not seen at all.
    for (const char* name : {"interface", "none", ""})
        CHECK(world_of(fmt::format("Material \"{}\" Shape \"sphere\"", name)).surfaces.empty());
}

TEST_CASE("pbrt's media", "[cpu][pbrt]") {
    const std::string fog = R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ]
        "rgb sigma_s" [ .5 .5 .5 ] "float scale" 10 "float g" .7 "rgb Le" [ 1 0 0 ] "float Lescale" 3
        Material "interface" )";
    const auto medium = [](const Scene& scene) {
        REQUIRE(scene.volumes.size() == 1);
        return scene.volumes[0];
    };
    const Volume ball =
        medium(world_of(fog + R"(MediumInterface "fog" "" Translate 1 0 2 Shape "sphere" "float radius" 3)"));
    CHECK(near(ball.sigma_a, {10, 20, 30}));
    CHECK(near(ball.sigma_s, glm::dvec3(5)));
    CHECK(ball.g == 0.7);
    CHECK(near(ball.Le, {3, 0, 0}));
    CHECK(near(glm::dvec3(ball.transform[3]), {1, 0, -2}));
    CHECK(std::cbrt(std::abs(glm::determinant(glm::dmat3(ball.transform)))) * std::get<Sphere>(ball.shape).radius ==
          Approx(3.0));

    const Volume box = medium(world_of(fog + R"(MediumInterface "fog" "" Rotate 20 0 1 0
        Shape "trianglemesh" "point3 P" [ 0 0 0  2 0 0  0 3 0  2 3 0  0 0 4  2 0 4  0 3 4  2 3 4 ] "integer indices"
        [ 0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5 ])"));
    CHECK(std::get<Box>(box.shape).size == glm::dvec3(1.0));
    CHECK(std::abs(glm::determinant(glm::dmat3(box.transform))) == Approx(24.0));

    const Volume model =
        medium(world_of(fog + R"(MediumInterface "fog" "" Shape "plymesh" "string filename" "a b.PLY")"));
    CHECK(std::get<MeshFiles>(model.shape).paths.at(0).filename() == "a b.PLY");

    // Around the camera it has no end.
    const Scene around = scene_of(fog + R"(MediumInterface "" "fog" Camera "perspective" WorldBegin)");
    CHECK(is_everywhere(medium(around)));
    // But where a shape about it, whose inside it is, ends it.
    const std::string before =
        fog + R"(MediumInterface "" "fog" LookAt 3 0 0  0 0 0  0 1 0 Camera "perspective" WorldBegin )";
    const std::string ball_of_fog = R"(MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" )";
    CHECK(std::holds_alternative<Sphere>(medium(scene_of(before + ball_of_fog + "4")).shape));
    CHECK(scene_of(before + ball_of_fog + "2").volumes.size() == 2);
    CHECK(scene_of(before + "Translate 3 0 0 " + ball_of_fog + "2").volumes.size() == 1);
    // Neither side differs: it bounds nothing.
    CHECK(world_of(fog + R"(MediumInterface "fog" "fog" Shape "sphere")").volumes.empty());

    const Scene grid = world_of(R"(Scale 2 2 2 MakeNamedMedium "c" "string type" "nanovdb" "string filename" "c.nvdb"
        "string gridname" "smoke" Identity Material "interface" MediumInterface "c" "" Shape "sphere" "float radius" 9
        Shape "sphere" "float radius" 10)");
    const Volume cloud = medium(grid); // once
    CHECK(std::get<GridFile>(cloud.shape).grid == "smoke");
    CHECK(near(cloud.sigma_s, glm::dvec3(1.0)));
    CHECK(cloud.unit == CoefficientUnit::world);
    CHECK(std::abs(glm::determinant(glm::dmat3(cloud.transform))) == Approx(8.0));

    const Scene milk = world_of(R"(MakeNamedMedium "m" "string type" "homogeneous" "string preset" "Wholemilk"
        Material "interface" MediumInterface "m" "" Shape "sphere")");
    CHECK(near(medium(milk).sigma_s, {2.55, 3.21, 3.77}));
}

TEST_CASE("pbrt's transforms, attributes and objects", "[cpu][pbrt]") {
    const auto at = [](const std::string& text) { // in pbrt's world
        const glm::dvec3 here = only_light<PointLight>(world_of(text)).position;
        return glm::dvec3(here.x, here.y, -here.z);
    };
    const std::string light = R"( LightSource "point" "point3 from" [ 1 0 0 ])";
    CHECK(near(at("Translate 1 2 3 Rotate 90 0 0 1" + light), {1, 3, 3}));
    CHECK(near(at("Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1 ]" + light), {6, 6, 7}));
    CHECK(near(at("Scale 2 2 2 ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1 ]" + light), {12, 12, 14}));
    CHECK(near(at("Translate 1 0 0 CoordinateSystem \"a\" Identity CoordSysTransform \"a\"" + light), {2, 0, 0}));
    CHECK(near(at("AttributeBegin Translate 9 9 9 AttributeEnd" + light), {1, 0, 0}));
    CHECK(near(at("TransformBegin Translate 9 9 9 TransformEnd" + light), {1, 0, 0}));
    CHECK(
        near(at("TransformTimes 0 1 ActiveTransform EndTime Translate 9 9 9 ActiveTransform All" + light), {1, 0, 0}));
    CHECK(near(at("# nothing\nTranslate 1 #2 3\n 2 3" + light), {2, 2, 3}));
    // Where the camera is: CoordSysTransform "camera".
    const Scene scene = scene_of("LookAt 4 5 6  0 0 0  0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform "
                                 "\"camera\" LightSource \"point\"");
    CHECK(near(only_light<PointLight>(scene).position, scene.camera.position));

    const Scene objects = world_of(R"(AttributeBegin Scale 2 2 2 ObjectBegin "o" Translate 1 0 0
        Attribute "shape" "float radius" .25
        Material "diffuse" "rgb reflectance" [ .9 0 0 ] Shape "sphere" ObjectEnd AttributeEnd
        ObjectInstance "o" Translate 0 3 0 Rotate 180 0 1 0 ObjectInstance "o" Shape "sphere")");
    REQUIRE(objects.surfaces.size() == 3);
    const auto ball = [&](int i) { return std::get<BallSurface>(objects.surfaces[i].shape); };
    CHECK(near(ball(0).center, {2, 0, 0}));
    CHECK(near(ball(1).center, {-2, 3, 0}));
    CHECK((ball(0).radius == Approx(0.5) && ball(1).radius == Approx(0.5) && ball(2).radius == Approx(1.0)));
    CHECK(near(objects.surfaces[1].material.color, {.9, 0, 0}));
    CHECK(near(objects.surfaces[2].material.color, glm::dvec3(.5)));
    // An instance may come before its object, a parameter twice, and a matrix have six digits.
    CHECK(world_of("ObjectInstance \"o\" ObjectBegin \"o\" Shape \"sphere\" ObjectEnd").surfaces.size() == 1);
    const auto radius = [](const std::string& text) {
        return std::get<BallSurface>(world_of(text).surfaces.at(0).shape).radius;
    };
    CHECK(radius("Shape \"sphere\" \"float radius\" 1 \"float radius\" 2") == Approx(2.0));
    CHECK(radius("Attribute \"shape\" \"float radius\" 1 \"float radius\" 2 Shape \"sphere\"") == Approx(2.0));
    CHECK(radius("Transform [ .707107 0 .707107 0 0 1 0 0 -.707107 0 .707107 0 0 0 0 1 ] Shape \"sphere\"") ==
          Approx(1.0).epsilon(1e-5));
}

TEST_CASE("pbrt's triangles", "[cpu][pbrt]") {
    const std::string board =
        R"(Texture "t" "spectrum" "imagemap" "string filename" "a.png" Material "diffuse" "texture reflectance" "t" )";
    const std::string corner = R"(Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "point2 uv" [ 0 0 1 0 0 1 ]
                                  "normal3 N" [ 0 0 1 0 0 1 0 1 1 ])";
    const Scene scene = world_of(board + corner);
    CHECK(std::get<TriangleSurface>(world_of(corner).surfaces.at(0).shape).places.empty()); // without a texture
    const auto& mesh = std::get<TriangleSurface>(scene.surfaces.at(0).shape);
    REQUIRE(mesh.triangles.size() == 1);
    // Mirrored, and turned about so that its front is where it was.
    CHECK(mesh.triangles[0] == glm::uvec3(0, 2, 1));
    CHECK(mesh.places.at(0)[1] == glm::vec2(0, 1));
    CHECK(near(mesh.normals.at(0)[1], glm::dvec3(0, 1, -1)));
    // The front is where the normals are, whatever the corners' order.
    const Scene faced = world_of(R"(Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 2 1 ]
                                    "normal3 N" [ 0 0 1 0 0 1 0 1 1 ])");
    CHECK(std::get<TriangleSurface>(faced.surfaces.at(0).shape).triangles.at(0) == glm::uvec3(0, 2, 1));
    // pbrt's places where a scene gives none, once there is a texture to see them by: of patches the corners', of
    // triangles (0, 0), (1, 0), (1, 1).
    const std::string square = R"("point3 P" [ 0 0 0 2 0 0 0 3 0 2 3 0 ])";
    const Scene patch = world_of(board + R"(Shape "bilinearmesh" )" + square);
    const auto& corners = std::get<TriangleSurface>(patch.surfaces.at(0).shape);
    REQUIRE(corners.triangles.size() == 2);
    for (int t = 0; t < 2; ++t)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 p = corners.vertices[corners.triangles[t][k]];
            CHECK(corners.places.at(t)[k] == glm::vec2(p.x / 2.0, p.y / 3.0));
        }
    const Scene pieces = world_of(board + R"(Shape "trianglemesh" "integer indices" [ 0 1 2 3 2 1 ] )" + square);
    const auto& halves = std::get<TriangleSurface>(pieces.surfaces.at(0).shape);
    for (int t = 0; t < 2; ++t) { // mirrored, so in another order
        CHECK(halves.places.at(t)[0] == glm::vec2(0, 0));
        CHECK(halves.places.at(t)[1] == glm::vec2(1, 1));
        CHECK(halves.places.at(t)[2] == glm::vec2(1, 0));
    }
    const Scene disk = world_of(board + R"(Shape "disk")");
    CHECK(std::get<TriangleSurface>(disk.surfaces.at(0).shape).places.size() == 128); // polar
    // What exporters say of a flat quad does not keep it from being a rectangle, nor a lamp.
    const Scene lamp = world_of(R"(AreaLightSource "diffuse" Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ]
        "point3 P" [ 0 0 0 2 0 0 2 3 0 0 3 0 ] "normal3 N" [ 0 0 1 0 0 1 0 0 1 0 0 1 ] "point2 uv" [ 0 0 1 0 1 1 0 1 ])");
    CHECK(std::holds_alternative<RectangleSurface>(lamp.surfaces.at(0).shape));
    // Not every two triangles are a rectangle, nor every twelve a box.
    PbrtTriangles kite{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1.1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
    CHECK_FALSE(as_rectangle(kite));
    kite.points[3].y = 1.0;
    CHECK(as_rectangle(kite));
    kite.triangles[1] = {0, 3, 2}; // faces away
    CHECK_FALSE(as_rectangle(kite));
    CHECK_FALSE(as_box(kite));
}

// Parts of quadrics, stretched ones and cylinders: on their surface, whole, with their front and their places on
// textures where pbrt has them.
TEST_CASE("pbrt's quadrics that are none here are triangles", "[cpu][pbrt]") {
    const auto mesh_of = [](const std::string& text) {
        const Scene scene = world_of(text);
        REQUIRE(scene.surfaces.size() == 1);
        return std::get<TriangleSurface>(scene.surfaces[0].shape);
    };
    const auto area_of = [](const TriangleSurface& mesh) {
        double sum = 0.0;
        for (const glm::uvec3& t : mesh.triangles)
            sum += 0.5 * glm::length(glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x],
                                                mesh.vertices[t.z] - mesh.vertices[t.x]));
        return sum;
    };
    // Part of the triangles that face the way that `front` has at their middle.
    const auto part_in_front = [](const TriangleSurface& mesh,
                                  const std::function<glm::dvec3(const glm::dvec3&)>& front) {
        double in_front = 0.0;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
            in_front += glm::dot(glm::cross(b - a, c - a), front((a + b + c) / 3.0)) > 0.0;
        }
        return in_front / double(mesh.triangles.size());
    };
    const auto outward = [](const glm::dvec3& p) { return p; };
    // A polygon of 128 corners in a circle: its perimeter is less by a part of (pi / 128)^2 / 6 = 1e-4.
    const TriangleSurface pipe = mesh_of("Shape \"cylinder\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 3");
    CHECK(area_of(pipe) == Approx(4.0 * pi * 4.0).epsilon(2e-4));
    for (const glm::dvec3& p : pipe.vertices)
        CHECK(std::hypot(p.x, p.y) == Approx(2.0));
    CHECK(part_in_front(pipe, [](const glm::dvec3& p) { return glm::dvec3(p.x, p.y, 0.0); }) == 1.0);
    CHECK(part_in_front(mesh_of("ReverseOrientation Shape \"cylinder\""),
                        [](const glm::dvec3& p) { return glm::dvec3(-p.x, -p.y, 0.0); }) == 1.0);
    // Closed shapes of glass enclose something.
    for (const char* closed :
         {"Scale 1 2 1 Shape \"sphere\"", "Scale 1 1 3 Rotate 40 1 1 0 Shape \"sphere\" \"float radius\" 0.7"})
        CHECK_NOTHROW(with_surface_files(world_of(std::string("Material \"dielectric\" ") + closed)));
    const TriangleSurface ellipsoid = mesh_of("Scale 1 2 3 Shape \"sphere\" \"float radius\" 0.5");
    for (const glm::dvec3& p : ellipsoid.vertices)
        CHECK(glm::length(p / glm::dvec3(0.5, 1.0, 1.5)) == Approx(1.0));
    CHECK(part_in_front(ellipsoid, outward) == 1.0);
    CHECK(part_in_front(mesh_of("Scale 1 2 -3 Shape \"sphere\""), outward) == 0.0); // a mirror turns pbrt's about
    for (std::size_t i = 0; i < ellipsoid.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 p = ellipsoid.vertices[ellipsoid.triangles[i][corner]];
            const glm::dvec3 normal = p / glm::dvec3(0.25, 1.0, 2.25);
            CHECK(glm::dot(glm::normalize(glm::dvec3(ellipsoid.normals.at(i)[corner])), glm::normalize(normal)) >
                  1.0 - 1e-6);
        }
    // A zone of a sphere has the area of the cylinder about it.
    const TriangleSurface zone = mesh_of("Shape \"sphere\" \"float zmin\" -0.2 \"float zmax\" 0.7 \"float phimax\" 90");
    CHECK(area_of(zone) == Approx(0.25 * 2.0 * pi * 0.9).epsilon(1e-3));
    for (const glm::dvec3& p : zone.vertices) { // pbrt's z, mirrored
        CHECK((p.x > -1e-9 && p.y > -1e-9 && -p.z > -0.2 - 1e-9 && -p.z < 0.7 + 1e-9));
        CHECK(glm::length(p) == Approx(1.0));
    }
    const TriangleSurface ring = mesh_of(
        R"(Texture "t" "spectrum" "imagemap" "string filename" "a.png" Material "diffuse" "texture reflectance" "t"
           Shape "disk" "float innerradius" 0.5 "float height" 2)");
    CHECK(area_of(ring) == Approx(pi * 0.75).epsilon(1e-3));
    CHECK(part_in_front(ring, [](const glm::dvec3&) { return glm::dvec3(0.0, 0.0, -1.0); }) == 1.0);
    // u once round from x to y, v from the outer edge to the inner.
    for (std::size_t i = 0; i < ring.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 p = ring.vertices[ring.triangles[i][corner]];
            const glm::vec2 place = ring.places.at(i)[corner];
            CHECK(place.y == Approx((1.0 - std::hypot(p.x, p.y)) / 0.5).margin(1e-6));
            CHECK(std::cos(2.0 * pi * place.x) == Approx(p.x / std::hypot(p.x, p.y)).margin(1e-5));
            CHECK(std::sin(2.0 * pi * place.x) == Approx(p.y / std::hypot(p.x, p.y)).margin(1e-5));
        }
    // A sphere that shines inwards, and one that is just turned and enlarged.
    const Scene inwards = world_of("ReverseOrientation AreaLightSource \"diffuse\" Shape \"sphere\"");
    REQUIRE(inwards.surfaces.size() == 1);
    CHECK(part_in_front(std::get<TriangleSurface>(inwards.surfaces[0].shape), [](const glm::dvec3& p) { return -p; }) ==
          1.0);
    const Scene turned = world_of("Rotate 30 1 2 3 Scale 2 -2 2 Shape \"sphere\"");
    CHECK(std::holds_alternative<BallSurface>(turned.surfaces.at(0).shape));
    CHECK_THROWS_WITH(world_of("Shape \"cylinder\" \"float zmin\" 1 \"float zmax\" 1"), Contains("has no area"));
    CHECK_THROWS_WITH(world_of("Shape \"cylinder\" \"float radius\" -1"), Contains("expected more than 0"));
}

TEST_CASE("what of a pbrt scene cannot be rendered is said once, with its place", "[cpu][pbrt]") {
    const auto noted = [](const std::string& text, const std::string& expected) {
        const Scene scene = world_of(text);
        CAPTURE(text);
        const auto has = [&](const std::string& warning) { return warning.find(expected) != warning.npos; };
        CHECK(std::count_if(scene.warnings.begin(), scene.warnings.end(), has) == 1);
    };
    noted("Shape \"curve\"", "s.pbrt:3:1: Shape \"curve\" is left out");
    noted("Material \"hair\" Shape \"sphere\" Shape \"sphere\"", "s.pbrt:3:1: Material \"hair\" is left out");
    noted("Shape \"sphere\" \"float phimax\" 90", "this sphere is 4032 triangles here"); // 32 x 64 x 2 - 2 x 32
    noted("Shape \"sphere\" \"float alpha\" .5", "\"alpha\" is left out");
    noted("Shape \"sphere\" \"float radios\" 2", "\"radios\" is left out");
    noted("LightSource \"goniometric\" \"string filename\" \"a.exr\"", "LightSource \"goniometric\" is left out");
    noted(
        "LightSource \"infinite\" \"string filename\" \"a.exr\" LightSource \"infinite\" \"string filename\" \"b.exr\"",
        "a second map of the sky");
    noted("Option \"bool disablepixeljitter\" true", "Option \"bool disablepixeljitter\" is left out");
    const auto textured = [](const std::string& texture) {
        return "Texture \"t\" \"spectrum\" " + texture +
               " Material \"diffuse\" \"texture reflectance\" \"t\" Shape "
               "\"sphere\"";
    };
    noted(textured("\"dots\""), "Texture \"dots\" is left out");
    noted(textured("\"checkerboard\" \"integer dimension\" 3"), "Texture \"checkerboard\" is left out");
    noted("Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" " +
              textured("\"checkerboard\" \"texture tex1\" \"i\""),
          "images in a Texture \"checkerboard\" are left out");
    noted("ActiveTransform EndTime", "nothing moves");
    noted("ActiveTransform StartTime", "nothing moves");
    noted(
        "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" MediumInterface \"a\" \"\" Material \"interface\" Shape "
        "\"disk\"",
        "\"disk\" encloses medium \"a\", which is left out");
}

TEST_CASE("wrong pbrt scenes are refused with their place", "[cpu][pbrt]") {
    const auto refused = [](const std::string& text, const std::string& why) {
        CAPTURE(text);
        CHECK_THROWS_WITH(scene_of(text), Contains(why));
    };
    refused("Shap \"sphere\"", "s.pbrt:1:1: 'Shap' is no directive; did you mean Shape?");
    refused("WorldBegin\n WorldBegin", "s.pbrt:2:2: a second WorldBegin");
    refused("WorldBegin\nFilm \"rgb\"", "s.pbrt:2:1: Film belongs before WorldBegin");
    refused("WorldBegin\nWorldEnd", "pbrt --upgrade");
    refused("Translate 1 2", "the scene ends where a number is expected");
    refused("Translate 1 2 x", "s.pbrt:1:15: 'x': expected a number");
    refused("Scale 0 1 1", "Scale leaves nothing of space");
    refused("Transform [ 1 2 3 ]", "']': expected a number");
    refused("LookAt 0 0 0 0 0 0 0 1 0", "LookAt has no direction");
    refused("LookAt 0 0 0 0 1 0 0 1 0", "its up is along it");
    refused("Rotate 3 0 0 0", "Rotate lacks its axis");
    refused("Camera perspective", "'perspective': expected a type in quotes after Camera");
    refused("Camera \"realistic\" WorldBegin", "Camera \"realistic\" cannot be rendered");
    refused("Camera \"perspective\" \"fov\" 3", "\"fov\": expected a parameter with its type");
    refused("Camera \"perspective\" \"float fov\" [ 3", "lack their ]");
    refused("Camera \"perspective\" \"float fov\" [ 3 \"a\" ]", "'a' among the values of \"float fov\"");
    refused("Camera \"perspective\" \"float fov\" [ 3 4 ] WorldBegin", "\"float fov\": expected one number");
    refused("Camera \"perspective\" \"float fov\" 180 WorldBegin", "expected degrees between 0 and 180");
    refused("Film \"rgb\" \"integer xresolution\" 2.5 WorldBegin", "one whole number");
    refused("Film \"rgb\" \"integer xresolution\" 0 WorldBegin", "expected one at least");
    refused("Film \"rgb\" \"float iso\" 0 WorldBegin", "an exposure of 0");
    refused("WorldBegin AttributeEnd", "AttributeEnd without what it ends");
    refused("WorldBegin ObjectInstance \"o\"", "no object \"o\"; ObjectBegin defines one");
    refused("WorldBegin ObjectBegin \"o\" ObjectEnd ObjectBegin \"o\" ObjectEnd", "a second object \"o\"");
    refused("Camera \"perspective\"\n", "s.pbrt:2:1: the scene lacks its WorldBegin");
    refused("WorldBegin\n AttributeBegin\n AttributeBegin AttributeEnd",
            "s.pbrt:2:2: an AttributeBegin lacks its AttributeEnd");
    refused("WorldBegin MakeNamedMaterial \"m\" \"rgb reflectance\" [ 1 1 1 ]", "lacks its \"string type\"");
    refused("WorldBegin ObjectBegin \"o\"", "s.pbrt:1:12: ObjectBegin \"o\" lacks its ObjectEnd");
    refused("WorldBegin NamedMaterial \"m\" Shape \"sphere\"", "no material \"m\"; MakeNamedMaterial makes one");
    refused("WorldBegin Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"", "no texture \"t\"");
    refused("WorldBegin MediumInterface \"m\" \"\" Shape \"sphere\"", "no medium \"m\"");
    refused("WorldBegin MakeNamedMedium \"m\" \"string type\" \"agrid\" MediumInterface \"m\" \"\" Shape \"sphere\"",
            "medium \"agrid\" cannot be rendered");
    refused("WorldBegin Shape \"trianglemesh\"", "lacks its points");
    refused("WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]",
            "whole numbers from 0 to 2");
    refused("WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 ]", "three for each point");
    refused("Include \"none.pbrt\"", "none.pbrt: no such file");
    refused("Film \"rgb", "without its closing quote");
    refused("Film \"\\q\"", "unknown escape");
    refused("ColorSpace \"srgbb\"", "did you mean srgb?");
    refused("WorldBegin Attribute \"shapes\"", "did you mean shape?");
    refused("WorldBegin LightSource \"point\" \"rgb I\" [ 1 2 ]", "expected red, green and blue");
    refused("WorldBegin LightSource \"point\" \"spectrum I\" [ 500 1 400 2 ]", "wavelengths that ascend");
    refused("WorldBegin LightSource \"point\" \"spectrum I\" \"none.spd\"", "none.spd: no such file");
    // What this renderer's own scenes may not hold has the place in pbrt's.
    refused("WorldBegin\nLightSource \"spot\" \"float coneangle\" 95", "s.pbrt:2:1: a cone of 95 degrees");
    refused("WorldBegin\n\n  Shape \"sphere\" \"float radius\" 0", "s.pbrt:3:3: sphere of radius 0");
    CHECK_THROWS_WITH(load_scene("s.pbrt", {{"a", "b"}}), Contains("-D and -f fill in the $keys"));
    CHECK_NOTHROW(world_of("MakeNamedMaterial \"$a <b> & 'c'\" \"string type\" \"diffuse\" NamedMaterial \"$a <b> & "
                           "'c'\" Shape \"plymesh\" \"string filename\" \"$a <b> & 'c'.ply\""));
}

TEST_CASE("black bodies by their own maxima, as in pbrt", "[cpu][pbrt]") {
    // The observer's second response every 20 nm from 400 on (CIE 1931), and Planck's law over its maximum, at x
    // = 4.965.
    const auto expected = [](double kelvin) {
        const double ybar[] = {.0004, .0040, .0230, .0600, .1390, .3230, .7100, .9540,
                               .9950, .8700, .6310, .3810, .1750, .0610, .0170, .0041};
        double sum = 0.0, nm = 400.0;
        for (const double response : ybar) {
            const double b = 2.897771955e6 / (nm * kelvin);
            sum += 20.0 * response * std::pow(b, 5) * std::expm1(4.965114) / std::expm1(4.965114 * b);
            nm += 20.0;
        }
        return sum;
    };
    const auto luminance = [](const glm::dvec3& c) { return 0.2126729 * c.x + 0.7151522 * c.y + 0.0721750 * c.z; };
    for (const double kelvin : {2000.0, 3000.0, 5269.0, 9000.0}) // the fit of the observer is good to a percent
        CHECK(luminance(blackbody_rgb(kelvin, 0.0)) == Approx(expected(kelvin)).epsilon(0.01));
    CHECK(near(blackbody_rgb(2000.0, 0.0) / luminance(blackbody_rgb(2000.0, 0.0)),
               blackbody_rgb(2000.0, 2000.0) / luminance(blackbody_rgb(2000.0, 2000.0)), 1e-9));
    CHECK(blackbody_rgb(1.0, 0.0) == glm::dvec3(0.0));
}
