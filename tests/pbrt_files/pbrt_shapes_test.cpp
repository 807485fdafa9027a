// Shapes and materials of pbrt-v4's scenes: what they become.
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

#include "pbrt_scenes.h"
#include "pbrt_triangles.h"
#include "surface_mesh.h"

using namespace vkvol;
using Catch::Contains;
using std::numbers::pi;

namespace {

Material material(const std::string& text) {
    return world_of(text + "\nShape \"sphere\"").surfaces.at(0).material;
}

TriangleSurface mesh_of(const std::string& text) {
    const Scene scene = world_of(text);
    REQUIRE(scene.surfaces.size() == 1);
    return std::get<TriangleSurface>(scene.surfaces[0].shape);
}

double area_of(const TriangleSurface& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
        sum += 0.5 * glm::length(
                         glm::cross(mesh.vertices[t.y] - mesh.vertices[t.x], mesh.vertices[t.z] - mesh.vertices[t.x]));
    return sum;
}

// Part of the triangles that face the way that `front` has at their middle.
double part_in_front(const TriangleSurface& mesh, const std::function<glm::dvec3(const glm::dvec3&)>& front) {
    double in_front = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
        in_front += glm::dot(glm::cross(b - a, c - a), front((a + b + c) / 3.0)) > 0.0;
    }
    return in_front / double(mesh.triangles.size());
}

glm::dvec3 outward(const glm::dvec3& p) {
    return p;
}

} // namespace

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

TEST_CASE("pbrt's materials", "[cpu][pbrt]") {
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
    // Not seen at all.
    for (const char* name : {"interface", "none", ""})
        CHECK(world_of(fmt::format("Material \"{}\" Shape \"sphere\"", name)).surfaces.empty());
}

TEST_CASE("pbrt's textures", "[cpu][pbrt]") {
    const Material tiles = material(R"(Texture "t" "spectrum" "imagemap" "string filename" "t.png" "float uscale" 3
        Texture "s" "spectrum" "scale" "texture tex" "t" "float scale" .5
        MakeNamedMaterial "m" "string type" "diffuse" "texture reflectance" "s" NamedMaterial "m")");
    CHECK(tiles.texture.filename() == "t.png");
    CHECK(tiles.repeat == glm::dvec2(3, 1));
    CHECK(near(tiles.color, glm::dvec3(0.5)));

    // The square on the lower left is the first, two of them are a repeat, and colours by textures are as good.
    const auto board_of = [](const std::string& scales) {
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
}

TEST_CASE("parts of pbrt's quadrics are triangles", "[cpu][pbrt]") {
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

TEST_CASE("what of pbrt's scenes has no size is no error", "[cpu][pbrt]") {
    const char* line =
        R"(Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  1 0 0  0 0 0 ] "integer indices" [ 0 1 2 0 2 3 ])";
    const Scene flat = world_of(line);
    REQUIRE(flat.surfaces.size() == 1);
    CHECK(std::holds_alternative<TriangleSurface>(flat.surfaces[0].shape));
    const Scene stripes = world_of(R"(Texture "t" "spectrum" "checkerboard" "float uscale" 0 "float vscale" 8
        Material "diffuse" "texture reflectance" "t" Shape "sphere")");
    CHECK(stripes.surfaces.size() == 1);
    CHECK(world_of("Translate 1e-400 0 0 Shape \"sphere\"").surfaces.size() == 1);
}

TEST_CASE("pbrt's instances of more triangles than are read are refused", "[cpu][pbrt]") {
    std::string text =
        "ObjectBegin \"t\" Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [";
    for (int i = 0; i < 30000; ++i)
        text += " 0 1 2";
    text += " ] ObjectEnd\n";
    for (int i = 0; i < 700; ++i)
        text += "ObjectInstance \"t\"\n";
    CHECK_THROWS_WITH(world_of(text), Contains("s.pbrt:6") && Contains("20000000 triangles"));
}
