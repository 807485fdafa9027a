// Meshes that are none, and materials that are not there: found by tests/fuzz, kept here.
#include <catch2/catch.hpp>

#include "bvh.h"
#include "error.h"
#include "mesh.h"
#include "support/test_directory.h"

using namespace vkvol;
using Catch::Contains;

namespace {

const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

} // namespace

TEST_CASE("a material library that cannot be read is named", "[cpu][mesh]") {
    const TestDirectory directory;
    for (const std::string name : {"none.mtl", "/dev/zero", "."}) {
        CAPTURE(name);
        const Mesh mesh = load_mesh({{directory.write("mesh.obj", "mtllib " + name + "\n" + tetrahedron)}});
        CHECK(!mesh.diffuse);
        REQUIRE(mesh.warnings.size() == 1);
        CHECK_THAT(mesh.warnings[0],
                   Contains("mesh.obj: its material library") && Contains(name) && Contains("put it"));
    }
    // A library that can be read is taken, and then all is well.
    directory.write("red.mtl", "newmtl red\nKd 1 0 0\n");
    CHECK(load_mesh({{directory.write("mesh.obj", "mtllib red.mtl\n" + tetrahedron)}}).warnings.empty());
}

TEST_CASE("a material whose colour is none is left out", "[cpu][mesh]") {
    const TestDirectory directory;
    for (const std::string number : {"-1", "1e30"}) {
        CAPTURE(number);
        directory.write("red.mtl", "newmtl red\nKd 0.5 " + number + " 0\n");
        const Mesh mesh = load_mesh({{directory.write("mesh.obj", "mtllib red.mtl\n" + tetrahedron)}});
        CHECK(!mesh.diffuse);
        REQUIRE(mesh.warnings.size() == 1);
        CHECK_THAT(mesh.warnings[0], Contains("Kd of material \"red\""));
    }
}

TEST_CASE("a mesh that has no end is not begun", "[cpu][mesh]") {
    CHECK_THROWS_WITH(load_mesh({{"/dev/zero"}}), Contains("no regular file"));
    CHECK_THROWS_AS(load_mesh({{std::string(10000, 'x')}}), InputError);
}

TEST_CASE("triangles all in one place have a hierarchy", "[cpu][mesh]") {
    Mesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.assign(100, {0, 1, 2});
    CHECK(build_bvh(mesh, glm::dvec3(0.0)).triangles.size() == 300);
}

TEST_CASE("faces of what are no whole numbers are refused", "[cpu][mesh]") {
    const TestDirectory directory;
    for (const std::string face : {"f 1.5 2 3", "f 4294967297 2 3", "f 1 2 x", "f 1/1e0 2 3"}) {
        CAPTURE(face);
        CHECK_THROWS_WITH(load_mesh({{directory.write("mesh.obj", tetrahedron + face + "\n")}}),
                          Contains("mesh.obj:10: a face needs whole numbers") && Contains(face.substr(2)));
    }
    CHECK_NOTHROW(load_mesh({{directory.write("mesh.obj", tetrahedron + "f -4//  -2/-3 +3\t# and no more\n")}}));
}
