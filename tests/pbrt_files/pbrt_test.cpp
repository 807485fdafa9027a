// Scenes of pbrt-v4: what their directives become. What pbrt itself would do is written out here from its book and
// manual (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition; pbrt.org/fileformat-v4).
#include <cmath>
#include <numbers>

#include "blackbody.h"
#include "pbrt_scenes.h"
#include "support/scenes.h"

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

    const Scene wide =
        scene_of("ColorSpace \"rec2020\"\nCamera \"perspective\"\nWorldBegin\n"
                 "LightSource \"point\" \"rgb I\" [ 1 1 1 ]\nLightSource \"point\" \"rgb I\" [ 0.6274 0.0691 "
                 "0.0164 ]");
    CHECK(near(std::get<PointLight>(wide.lights[0]).intensity, glm::dvec3(1.0), 1e-3));
    CHECK(near(std::get<PointLight>(wide.lights[1]).intensity, {1, 0, 0}, 2e-3)); // red of Rec.709, by ITU-R BT.2087
}

TEST_CASE("pbrt's maps of given illuminance shine as pbrt's do", "[cpu][pbrt]") {
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
}

TEST_CASE("pbrt's media", "[cpu][pbrt]") {
    const std::string fog = R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ]
        "rgb sigma_s" [ .5 .5 .5 ] "float scale" 10 "float g" .7 "rgb Le" [ 1 0 0 ] "float Lescale" 3 )",
                      in_world = fog + R"(Material "interface" )";
    const auto medium = [](const Scene& scene) {
        REQUIRE(scene.volumes.size() == 1);
        return scene.volumes[0];
    };
    const Volume ball =
        medium(world_of(in_world + R"(MediumInterface "fog" "" Translate 1 0 2 Shape "sphere" "float radius" 3)"));
    CHECK(near(ball.sigma_a, {10, 20, 30}));
    CHECK(near(ball.sigma_s, glm::dvec3(5)));
    CHECK(ball.g == 0.7);
    CHECK(near(ball.Le, {3, 0, 0}));
    CHECK(near(glm::dvec3(ball.transform[3]), {1, 0, -2}));
    CHECK(std::cbrt(std::abs(glm::determinant(glm::dmat3(ball.transform)))) * std::get<Sphere>(ball.shape).radius ==
          Approx(3.0));

    const Volume box = medium(world_of(in_world + R"(MediumInterface "fog" "" Rotate 20 0 1 0
        Shape "trianglemesh" "point3 P" [ 0 0 0  2 0 0  0 3 0  2 3 0  0 0 4  2 0 4  0 3 4  2 3 4 ] "integer indices"
        [ 0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5 ])"));
    CHECK(std::get<Box>(box.shape).size == glm::dvec3(1.0));
    CHECK(std::abs(glm::determinant(glm::dmat3(box.transform))) == Approx(24.0));

    const Volume model =
        medium(world_of(in_world + R"(MediumInterface "fog" "" Shape "plymesh" "string filename" "a b.PLY")"));
    CHECK(std::get<MeshFiles>(model.shape).paths.at(0).filename() == "a b.PLY");

    // Around the camera it has no end.
    const Scene around = scene_of(fog + R"(MediumInterface "" "fog" Camera "perspective" WorldBegin)");
    CHECK(is_everywhere(medium(around)));
    // But where a shape about it, whose inside it is, ends it.
    const std::string before =
        fog + R"(MediumInterface "" "fog" LookAt 3 0 0  0 0 0  0 1 0 Camera "perspective" WorldBegin )";
    const std::string ball_of_fog = R"(MediumInterface "fog" "" Material "interface" Shape "sphere" "float radius" )";
    CHECK(std::holds_alternative<Sphere>(medium(scene_of(before + ball_of_fog + "4")).shape));
    CHECK(scene_of(before + ball_of_fog + "2").volumes.size() == 1); // it has fog within already
    CHECK(scene_of(before + "Translate 3 0 0 " + ball_of_fog + "2").volumes.size() == 1);
    // Neither side differs: it bounds nothing.
    CHECK(world_of(in_world + R"(MediumInterface "fog" "fog" Shape "sphere")").volumes.empty());

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
    CHECK(near(at("ActiveTransform EndTime Translate 9 9 9 ActiveTransform All" + light), {1, 0, 0}));
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
    noted("Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" \"string filter\" \"point\" Material "
          "\"diffuse\" "
          "\"texture reflectance\" \"i\" Shape \"sphere\"",
          "filter \"point\" is left out");
    noted("Material \"conductor\" \"float roughness\" 4 Shape \"sphere\"", "alpha = 2, is 1 here");
    noted("ActiveTransform EndTime", "nothing moves");
    noted("ActiveTransform StartTime", "nothing moves");
    noted(
        "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" MediumInterface \"a\" \"\" Material \"interface\" Shape "
        "\"disk\"",
        "\"disk\" encloses medium \"a\", which is left out");
}

TEST_CASE("perspective in pbrt's maps is refused, but for what inverting a matrix leaves", "[cpu][pbrt]") {
    CHECK_NOTHROW(world_of("Transform [ 1 0 0 1e-17 0 1 0 -3e-9 0 0 1 0 0 0 0 1 ]"));
    CHECK_THROWS_WITH(scene_of("Transform [ 1 0 0 3 0 1 0 0 0 0 1 0 0 0 0 1 ]"), Contains("Transform has perspective"));
    CHECK_THROWS_WITH(scene_of("ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0 ]"),
                      Contains("ConcatTransform has perspective"));
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
