// Meshes that stand in a scene file.
#include <catch2/catch.hpp>

#include "error.h"
#include "support/scene_text.h"
#include "support/test_directory.h"
#include "surface_mesh.h"

using namespace vkvol;
using Catch::Contains;

namespace {

const std::string corners = "<vertices>0 0 0  1 0 0  0 1 0  0 0 1</vertices>";
const std::string tetrahedron = corners + "<triangles>0 2 1  0 1 3  0 3 2  1 2 3</triangles>";

std::string mesh(const std::string& inside, const std::string& attributes = {}) {
    return "<surfaces><mesh" + attributes + ">" + inside + "</mesh></surfaces>";
}

TriangleSurface read_triangles(const std::string& body) {
    return std::get<TriangleSurface>(with_surface_files(parse(body)).surfaces.at(0).shape);
}

} // namespace

TEST_CASE("meshes in scene files have their vertices, normals and places", "[cpu][xml][surfaces]") {
    const std::string triangle = "<vertices>0 0 0  1 0 0  0 1 0</vertices><triangles>0 1 2</triangles>"
                                 "<normals>0 0 2  0 0 1  1 0 1</normals><places>0 0  1 0  0 1</places>";
    const TriangleSurface plain = read_triangles(mesh(triangle));
    CHECK(plain.vertices == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(plain.triangles == std::vector<glm::uvec3>{{0, 1, 2}});
    CHECK(plain.normals[0][0] == glm::vec3(0, 0, 1)); // made unit
    CHECK(glm::distance(plain.normals[0][2], glm::vec3(std::sqrt(0.5), 0.0, std::sqrt(0.5))) < 1e-6f);
    CHECK(plain.places == std::vector<glm::mat3x2>{{{0, 0}, {1, 0}, {0, 1}}});
    // Mirrored and stretched: the front stays in front, and normals stay across.
    const TriangleSurface mirrored = read_triangles(mesh(triangle + "<transform><scale x=\"-2\"/></transform>"));
    CHECK(mirrored.vertices[1] == glm::dvec3(-2, 0, 0));
    CHECK(mirrored.triangles == std::vector<glm::uvec3>{{0, 2, 1}});
    CHECK(mirrored.places[0][1] == glm::vec2(0, 1));
    CHECK(glm::distance(mirrored.normals[0][1], glm::normalize(glm::vec3(-0.5, 0, 1))) < 1e-6f);
}

TEST_CASE("meshes of glass in scene files have to be closed", "[cpu][xml][surfaces]") {
    const std::string glass = " material=\"dielectric\"";
    CHECK(read_triangles(mesh(tetrahedron, glass)).triangles.size() == 4);
    CHECK_THROWS_AS(read_triangles(mesh(corners + "<triangles>0 2 1  0 1 3  0 3 2</triangles>", glass)), InputError);
    CHECK(read_triangles(mesh(corners + "<triangles>0 2 1  0 1 3  0 3 2</triangles>")).triangles.size() == 3);
}

TEST_CASE("a mesh ends where its faces do, wherever loose vertices are", "[cpu][xml][surfaces]") {
    const std::string loose = "<vertices>1e6 0 0  0 0 0  1 0 0  0 1 0  0 0 -1e6</vertices><triangles>1 2 3</triangles>";
    const auto check_bounds = [](const Scene& scene) {
        const SurfaceBounds bounds = bounds_of(with_surface_files(scene).surfaces).value();
        CHECK(bounds.low == glm::dvec3(0.0));
        CHECK(bounds.high == glm::dvec3(1, 1, 0));
    };
    check_bounds(parse(mesh(loose)));
    CHECK(read_triangles(mesh(loose)).triangles.front() == glm::uvec3(0, 1, 2));
    const TestDirectory directory;
    const std::string obj = "v 1e6 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1e6\nf 2 3 4\n";
    check_bounds(parse(mesh("", " file=\"" + directory.write("loose.obj", obj).string() + "\"")));
}

TEST_CASE("transforms may not take surfaces beyond what single precision holds", "[cpu][xml][surfaces]") {
    const std::string far = "<transform><scale value=\"1e6\"/></transform>";
    for (const std::string& shape :
         {"<sphere radius=\"1e6\">" + far + "</sphere>", "<disk x=\"1e6\" lookAt=\"0 0 0\">" + far + "</disk>",
          "<box x=\"-1e6\">" + far + "</box>"})
        CHECK_THROWS_WITH(with_surface_files(parse("<surfaces>" + shape + "</surfaces>")),
                          Contains("s.xml:1:20: ") && Contains("lengths and coordinates end at 1e+11"));
    for (const std::string& shape : {"<sphere radius=\"1e5\">" + far + "</sphere>",
                                     std::string("<sphere x=\"1e11\" y=\"-1e11\" z=\"1e11\" radius=\"1e11\"/>")})
        CHECK_NOTHROW(with_surface_files(parse("<surfaces>" + shape + "</surfaces>")));
}

TEST_CASE("wrong meshes in scene files are refused with their place", "[cpu][xml][surfaces]") {
    const auto refused = [](const std::string& inside) { return error_of(mesh(inside)); };
    CHECK_THAT(refused(corners), Contains("no <triangles>"));
    CHECK_THAT(refused(corners + "<triangles>0 1</triangles>"), Contains("2 numbers") && Contains("3 for each"));
    CHECK_THAT(refused(corners + "<triangles>0 1 4</triangles>"), Contains("4 is none of the 4 vertices"));
    CHECK_THAT(refused(corners + "<triangles>0 1 1.5</triangles>"), Contains("1.5 is none"));
    CHECK_THAT(refused(corners + "<triangles>0 1 -1</triangles>"), Contains("-1"));
    CHECK_THAT(refused("<vertices>0 0 0 1</vertices><triangles>0 0 0</triangles>"), Contains("<vertices> has 4"));
    CHECK_THAT(refused("<vertices></vertices><triangles>0 0 0</triangles>"), Contains("<vertices> has 0"));
    CHECK_THAT(refused(tetrahedron + "<normals>0 0 1</normals>"), Contains("<normals> is for 1 vertices, of 4"));
    CHECK_THAT(refused(tetrahedron + "<places>0 1 0</places>"), Contains("<places> has 3"));
    CHECK_THAT(refused("<triangles>0 1 2</triangles>"), Contains("unknown element <triangles>"));
    CHECK_THAT(refused(""), Contains("names no file"));
    CHECK_THROWS_WITH(with_surface_files(parse(mesh(tetrahedron, " texture=\"none.png\""))), Contains("add <places>"));
}

TEST_CASE("a mesh in the scene file has its texture in a folder, and its normals in the file", "[cpu][xml][surfaces]") {
    const auto with = [](const std::string& attributes) {
        return parse("<surfaces><mesh" + attributes + "><vertices>0 0 0  1 0 0  0 1 0</vertices><triangles>0 1 2" +
                     "</triangles><places>0 0  1 0  0 1</places></mesh></surfaces>");
    };
    CHECK(with(" texture=\"wood.png\" baseDir=\"images\"").surfaces.front().material.texture.filename() == "wood.png");
    CHECK(with(" texture=\"wood.png\" baseDir=\"images\"").surfaces.front().material.texture.parent_path().filename() ==
          "images");
    CHECK_THROWS_WITH(with(" normals=\"smooth\""), Contains("is for those of a file"));
    CHECK_THROWS_WITH(with(" file=\"a.obj\""), Contains("names a file and has <vertices>"));
    CHECK_THROWS_WITH(with(" baseDir=\"images\""), Contains("unknown attribute 'baseDir'"));
}
