// Scenes of pbrt-v4: what their directives become. What pbrt itself would do is written out here from its book and
// manual (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition; pbrt.org/fileformat-v4).
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "blackbody.h"
#include "pbrt_scene.h"
#include "pbrt_triangles.h"
#include "scene_xml.h"
#include "tests/reference/camera.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Scene scene_of(const std::string& text) {
    return parse_scene(translate_pbrt(read_pbrt(text, "s.pbrt")), "s.pbrt");
}

// A world of this after a plain beginning.
Scene world_of(const std::string& text) {
    return scene_of("Camera \"perspective\"\nWorldBegin\n" + text);
}

bool near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
    return glm::distance(a, b) <= tolerance * std::max(1.0, glm::length(b));
}

template <class Kind> Kind only_light(const Scene& scene) {
    REQUIRE(scene.lights.size() == 1);
    REQUIRE(std::holds_alternative<Kind>(scene.lights[0]));
    return std::get<Kind>(scene.lights[0]);
}

// Where on the picture a point of this renderer's world is seen, in pixels.
glm::dvec2 pixel_here(const Scene& scene, const glm::dvec3& point) {
    const Picture& picture = scene.picture;
    const auto ray = [&](double x, double y) { return reference::camera_ray(scene.camera, picture, x, y).direction; };
    const glm::dvec3 a = ray(0, 0), b = ray(picture.width, 0), c = ray(0, picture.height);
    const glm::dvec3 middle = reference::camera_ray(scene.camera, {2, 2, 0.0, 0.0, 2.0, 2.0}, 1, 1).direction; // ahead
    const auto flat = [&](const glm::dvec3& d) { return d / glm::dot(d, middle); };
    const glm::dvec3 corner = flat(a), right = flat(b) - corner, down = flat(c) - corner;
    const glm::dvec3 there = flat(point - scene.camera.position) - corner;
    return {picture.width * glm::dot(there, right) / glm::dot(right, right),
            picture.height * glm::dot(there, down) / glm::dot(down, down)};
}

glm::dmat4 pbrt_look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    const glm::dvec3 z = glm::normalize(target - eye), x = glm::normalize(glm::cross(up, z)), y = glm::cross(z, x);
    glm::dmat4 to_camera(1.0);
    for (int i = 0; i < 3; ++i) {
        to_camera[i] = {x[i], y[i], z[i], 0.0};
        to_camera[3][i] = -glm::dot(i == 0 ? x : i == 1 ? y : z, eye);
    }
    return to_camera;
}

} // namespace

TEST_CASE("pbrt's cameras see every point where pbrt sees it", "[cpu][pbrt]") {
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 60; ++i) {
        const auto vector = [&] { return glm::dvec3(any(rng), any(rng), any(rng)); };
        const glm::dvec3 eye = 5.0 * vector(), target = vector(), up = glm::dvec3(0, 1, 0) + 0.4 * vector();
        const glm::dvec3 axis = vector();
        const double angle = 180.0 * any(rng), size = i % 3 == 0 ? 0.1 + std::abs(any(rng)) : 1.0;
        const bool mirrors = i % 2 == 0, has_window = i % 5 == 0, has_crop = i % 4 == 0, has_map = i % 7 < 3;
        const int width = 60 + i, height = 150 - 2 * i; // wide and high
        const double fov = 20.0 + i;
        const glm::dvec3 scale(mirrors ? -size : size, size, size);
        std::string text = fmt::format("Scale {} {} {}\nRotate {} {} {} {}\nLookAt {} {} {} {} {} {} {} {} {}\n",
                                       scale.x, scale.y, scale.z, angle, axis.x, axis.y, axis.z, eye.x, eye.y, eye.z,
                                       target.x, target.y, target.z, up.x, up.y, up.z);
        const glm::dmat4 to_camera = glm::scale(glm::dmat4(1.0), scale) *
                                     glm::rotate(glm::dmat4(1.0), glm::radians(angle), glm::normalize(axis)) *
                                     pbrt_look_at(eye, target, up);

        const double aspect = double(width) / height;
        glm::dvec4 screen =
            aspect > 1.0 ? glm::dvec4(-aspect, aspect, -1.0, 1.0) : glm::dvec4(-1.0, 1.0, -1.0 / aspect, 1.0 / aspect);
        if (has_window)
            screen = 0.7 * screen + glm::dvec4(0.3, 0.3, -0.2, -0.2);
        text += fmt::format("Camera \"perspective\" \"float fov\" [ {} ]", fov);
        if (has_window)
            text += fmt::format(" \"float screenwindow\" [ {} {} {} {} ]", screen[0], screen[1], screen[2], screen[3]);
        text += fmt::format("\nFilm \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {}", width, height);
        const int left = has_crop ? width / 4 : 0, top = has_crop ? height / 3 : 0;
        if (has_crop)
            text += fmt::format(" \"integer pixelbounds\" [ {} {} {} {} ]", left, width - 3, top, height - 5);
        // Before the camera, whatever that does to the size of things.
        const glm::dvec3 there = glm::dvec3(glm::inverse(to_camera) * glm::dvec4(any(rng), any(rng), 4.0, 1.0));
        text += fmt::format("\nWorldBegin\nLightSource \"point\" \"point3 from\" [ {} {} {} ]\n", there.x, there.y,
                            there.z);
        if (has_map)
            text += fmt::format("Rotate {} {} {} {}\nLightSource \"infinite\" \"string filename\" \"sky.exr\"\n",
                                2 * angle, axis.y, axis.x, axis.z);
        const Scene scene = scene_of(text);
        CAPTURE(text);

        const glm::dvec3 p = glm::dvec3(to_camera * glm::dvec4(there, 1.0));
        const glm::dvec2 s = glm::dvec2(p) / p.z / std::tan(0.5 * glm::radians(fov));
        const glm::dvec2 pbrt((s.x - screen[0]) / (screen[1] - screen[0]) * width - left,
                              (screen[3] - s.y) / (screen[3] - screen[2]) * height - top);
        const glm::dvec2 here = pixel_here(scene, std::get<PointLight>(scene.lights[0]).position);
        CHECK(here.x == Approx(pbrt.x).epsilon(1e-6).margin(1e-6));
        CHECK(here.y == Approx(pbrt.y).epsilon(1e-6).margin(1e-6));
        CHECK(glm::distance(scene.camera.position, std::get<PointLight>(scene.lights[0]).position) ==
              Approx(glm::length(p) / size));
        CHECK(scene.picture.width == (has_crop ? width - 3 - left : width));
    }
}

TEST_CASE("pbrt's other cameras, lenses and films", "[cpu][pbrt]") {
    const Scene scene = scene_of(R"(Scale 2 2 2
        Camera "perspective" "float lensradius" 0.25 "float focaldistance" 8 "float shutterclose" 0.5
        Film "rgb" "float iso" 400 "integer xresolution" 30 "integer yresolution" 20
        PixelFilter "triangle" "float xradius" 1 "float yradius" 1
        Sampler "stratified" "integer xsamples" 5 "integer ysamples" 3
        Integrator "path" "integer maxdepth" 7
        WorldBegin LightSource "infinite" "rgb L" [ 1 2 3 ])");
    CHECK(scene.camera.lens.radius == Approx(0.125)); // of the world
    CHECK(scene.camera.lens.focus == Approx(4.0));
    CHECK(near(scene.background, {2, 4, 6})); // by half a second at ISO 400
    CHECK(scene.settings.pixel_filter == PixelFilter::tent);
    CHECK(scene.settings.pixel_filter_radius == 1.0);
    CHECK(scene.settings.spp == 15);
    CHECK(scene.settings.max_depth == 7u);
    CHECK(scene.warnings.empty());

    const Scene flat = scene_of(R"(Scale 2 2 2 Camera "orthographic" "float screenwindow" [ -3 3 -2 2 ]
        Film "rgb" "integer xresolution" 30 "integer yresolution" 20 WorldBegin)");
    CHECK(flat.camera.projection == Projection::orthographic);
    CHECK(flat.camera.view_height == Approx(2.0));

    // As pbrt leaves it: 1280 by 720, 16 samples, five scatterings, a Gaussian.
    const Scene usual = scene_of("WorldBegin");
    CHECK((usual.picture.width == 1280 && usual.picture.height == 720));
    CHECK((usual.settings.spp == 16 && usual.settings.max_depth == 5u));
    CHECK((usual.settings.pixel_filter == PixelFilter::gaussian && usual.settings.pixel_filter_radius == 1.5));
    CHECK(usual.camera.fov == Approx(90.0)); // of the shorter edge
}

TEST_CASE("pbrt's spherical pictures go round as pbrt's do", "[cpu][pbrt]") {
    // Camera space, x right, y up, z ahead: column c of n shows (cos a, y, sin a), a = 2 pi c / n.
    for (const char* mirror : {"", "Scale -1 1 1 "})
        for (const double column : {10.0, 37.0, 81.0}) {
            const double a = 2.0 * std::numbers::pi * column / 100.0;
            const glm::dvec3 seen(std::cos(a), 0.3, std::sin(a));
            const Scene scene = scene_of(
                fmt::format("{}Camera \"spherical\" \"string mapping\" \"equirectangular\"\nFilm \"rgb\" \"integer "
                            "xresolution\" 100 "
                            "\"integer yresolution\" 50\nWorldBegin LightSource \"point\" \"point3 from\" [ {} {} {} ]",
                            mirror, *mirror ? -seen.x : seen.x, seen.y, seen.z));
            const glm::dvec3 there = only_light<PointLight>(scene).position - scene.camera.position;
            const auto ray = reference::camera_ray(scene.camera, scene.picture, column,
                                                   50.0 * std::acos(0.3 / glm::length(seen)) / std::numbers::pi);
            CAPTURE(mirror, column);
            CHECK(near(ray.direction, glm::normalize(there), 1e-6));
        }
}

TEST_CASE("pbrt's lights shine as pbrt's do", "[cpu][pbrt]") {
    constexpr double pi = std::numbers::pi;
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

TEST_CASE("what shines in pbrt's scenes", "[cpu][pbrt]") {
    const auto lamp = [](const std::string& text) {
        const Scene scene = world_of("AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] " + text);
        REQUIRE(scene.surfaces.size() == 1);
        return scene.surfaces[0];
    };
    // Of 3 by 2, in the order that has its front towards -z of pbrt, which is +z here.
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
        CHECK(surface.emission.x * area * std::numbers::pi == Approx(10.0));
    };
    const std::string watts = R"(AreaLightSource "diffuse" "float power" 10 )";
    power((watts + R"(Shape "sphere" "float radius" 0.5)").c_str(), 4.0 * std::numbers::pi);
    power((watts + R"(Shape "disk" "float radius" 0.5)").c_str(), std::numbers::pi);
    power((watts + "Shape \"trianglemesh\" " + quad).c_str(), 24.0);
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
    const Material copper = material(R"(Material "conductor")");
    CHECK(near(copper.k, {3.912, 2.452, 2.142}));
    // Fresnel's reflectance at normal incidence is what was asked for.
    const Material grey = material(R"(Material "conductor" "rgb reflectance" [ .3 .5 .9 ])");
    for (int c = 0; c < 3; ++c) {
        const double n = grey.eta[c], k = grey.k[c];
        CHECK(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k) == Approx(c == 0 ? .3 : c == 1 ? .5 : .9));
    }
    const Material coat = material(R"(Material "coateddiffuse" "float eta" 1.7 "rgb reflectance" [ 1 .5 0 ])");
    CHECK((coat.kind == MaterialKind::coated && coat.ior == Approx(1.7)));

    const Material tiles = material(R"(Texture "t" "spectrum" "imagemap" "string filename" "t.png" "float uscale" 3
        Texture "s" "spectrum" "scale" "texture tex" "t" "float scale" .5
        MakeNamedMaterial "m" "string type" "diffuse" "texture reflectance" "s" NamedMaterial "m")");
    CHECK(tiles.texture.filename() == "t.png");
    CHECK(tiles.repeat == glm::dvec2(3, 1));
    CHECK(near(tiles.color, glm::dvec3(0.5)));

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
}

TEST_CASE("pbrt's triangles", "[cpu][pbrt]") {
    const Scene scene = world_of(R"(Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "point2 uv" [ 0 0 1 0 0 1 ]
                                    "normal3 N" [ 0 0 1 0 0 1 0 1 1 ])");
    const auto& mesh = std::get<TriangleSurface>(scene.surfaces.at(0).shape);
    REQUIRE(mesh.triangles.size() == 1);
    // Mirrored, and turned about so that its front is where it was.
    CHECK(mesh.triangles[0] == glm::uvec3(0, 2, 1));
    CHECK(mesh.places.at(0)[1] == glm::vec2(0, 1));
    CHECK(near(mesh.normals.at(0)[1], glm::dvec3(0, 1, -1)));
    // Not every two triangles are a rectangle, nor every twelve a box.
    PbrtTriangles kite{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1.1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
    CHECK_FALSE(as_rectangle(kite));
    kite.points[3].y = 1.0;
    CHECK(as_rectangle(kite));
    kite.triangles[1] = {0, 3, 2}; // faces away
    CHECK_FALSE(as_rectangle(kite));
    CHECK_FALSE(as_box(kite));
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
    noted("Shape \"sphere\" \"float phimax\" 90", "a part of a sphere is whole");
    noted("Shape \"sphere\" \"float alpha\" .5", "\"alpha\" is left out");
    noted("Shape \"sphere\" \"float radios\" 2", "\"radios\" is left out");
    noted("LightSource \"goniometric\" \"string filename\" \"a.exr\"", "LightSource \"goniometric\" is left out");
    noted(
        "LightSource \"infinite\" \"string filename\" \"a.exr\" LightSource \"infinite\" \"string filename\" \"b.exr\"",
        "a second map of the sky");
    noted("Option \"bool disablepixeljitter\" true", "Option \"bool disablepixeljitter\" is left out");
    noted("Texture \"t\" \"spectrum\" \"checkerboard\" Material \"diffuse\" \"texture reflectance\" \"t\" Shape "
          "\"sphere\"",
          "Texture \"checkerboard\" is left out");
    noted("ActiveTransform EndTime", "nothing moves");
    noted("Material \"thindielectric\" Shape \"sphere\"", "a thin pane is left out");
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
    refused("WorldBegin ObjectInstance \"o\"", "no object \"o\" before this");
    refused("WorldBegin ObjectBegin \"o\"", "lacks its ObjectEnd");
    refused("WorldBegin NamedMaterial \"m\" Shape \"sphere\"", "no material \"m\"; MakeNamedMaterial makes one");
    refused("WorldBegin Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"", "no texture \"t\"");
    refused("WorldBegin MediumInterface \"m\" \"\" Shape \"sphere\"", "no medium \"m\"");
    refused("WorldBegin MakeNamedMedium \"m\" \"string type\" \"cloud\" MediumInterface \"m\" \"\" Shape \"sphere\"",
            "medium \"cloud\" cannot be rendered");
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
    refused("WorldBegin\n\n  Shape \"sphere\" \"float radius\" 0", "s.pbrt:3:3: <sphere> radius");
    CHECK_THROWS_WITH(load_scene("s.pbrt", {{"a", "b"}}), Contains("-D and -f fill in the $keys"));
    CHECK_NOTHROW(world_of("MakeNamedMaterial \"$a <b> & 'c'\" \"string type\" \"diffuse\" NamedMaterial \"$a <b> & "
                           "'c'\" Shape \"plymesh\" \"string filename\" \"$a <b> & 'c'.ply\""));
}

TEST_CASE("black bodies by their own maxima, as in pbrt", "[cpu][pbrt]") {
    // By Wien's law that of 5269 K is at 550 nm, about which the observer sees: nearly the whole of ybar, 106.9 nm.
    const auto luminance = [](const glm::dvec3& c) { return 0.2126729 * c.x + 0.7151522 * c.y + 0.0721750 * c.z; };
    CHECK(luminance(blackbody_rgb(5269.0, 0.0)) == Approx(105.5).epsilon(0.01));
    // Planck's law over its maximum, at 2000 K and 560 nm, the middle of ybar: b^5 (e^x - 1) / (e^(x b) - 1) with
    // x = 4.965 and b = 1448.9 / 560. It rises by 1.4 % a nanometre there, and over ybar, of a deviation of some 42 nm,
    // its mean is larger by some e^(0.014^2 42^2 / 2).
    const double b = 1448.886 / 560.0;
    const double middle = std::pow(b, 5) * std::expm1(4.965114) / std::expm1(4.965114 * b);
    CHECK(luminance(blackbody_rgb(2000.0, 0.0)) / 106.9 == Approx(1.19 * middle).epsilon(0.1));
    CHECK(near(blackbody_rgb(2000.0, 0.0) / luminance(blackbody_rgb(2000.0, 0.0)),
               blackbody_rgb(2000.0, 2000.0) / luminance(blackbody_rgb(2000.0, 2000.0)), 1e-9));
    CHECK(blackbody_rgb(1.0, 0.0) == glm::dvec3(0.0));
}
