// .ply files: what they say is what the same mesh says as .obj; and files that are none.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "error.h"
#include "mesh.h"
#include "polygons.h"
#include "support/test_directory.h"
#include "support/test_meshes.h"

using namespace vkvol;
using Catch::Contains;

namespace {

struct PlyDirectory : TestDirectory {
    std::string error_of(const std::string& text) const {
        try {
            read_polygons(write("mesh.ply", text));
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
};

const std::string head = "ply\nformat ascii 1.0\ncomment of nobody\nelement vertex 4\nproperty float x\n"
                         "property float y\nproperty double z\nproperty uchar red\n";
const std::string square = "0 0 0 255\n1 0 0 0\n1 1 0.5 7\n0 1 0 9\n";

} // namespace

TEST_CASE("a .ply file of any format is the mesh that was written", "[cpu][mesh]") {
    const PlyDirectory directory;
    const Mesh box = make_box({0, 0, 0}, {1, 2, 3}, 2);
    for (const PlyFormat format : {PlyFormat::ascii, PlyFormat::little_endian, PlyFormat::big_endian}) {
        const Polygons read = read_polygons(directory.write("box.PLY", as_ply(box, format)));
        CHECK(read.vertices == box.vertices);
        CHECK(read.triangles == box.triangles);
    }
    const Mesh closed = load_mesh({{directory.path / "box.PLY"}});
    CHECK(closed.triangles.size() == box.triangles.size());
}

TEST_CASE("polygons of a .ply file become fans, and the rest of it is passed over", "[cpu][mesh]") {
    const PlyDirectory directory;
    const Polygons read = read_polygons(
        directory.write("quad.ply", head +
                                        "element strip 1\nproperty list uchar int of\nelement face 1\n"
                                        "property list uchar int vertex_index\nproperty float quality\nend_header\n" +
                                        square + "2 7 8\n4 0 1 2 3 0.5\n"));
    CHECK(read.vertices.at(2) == glm::dvec3(1.0, 1.0, 0.5));
    CHECK(read.triangles == std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("a .ply file that is none is refused by name and place", "[cpu][mesh]") {
    {
        const TestDirectory two;
        CHECK_THROWS_WITH(
            read_polygons(two.write("two.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                               "element vertex 1\nproperty float x\nend_header\n0\n0\n")),
            Catch::Contains("two elements \"vertex\""));
    }
    const PlyDirectory directory;
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    CHECK_THAT(directory.error_of("v 0 0 0\nf 1 1 1\n"), Contains("mesh.ply: not a .ply file"));
    CHECK_THAT(directory.error_of("ply\nformat ascii 1.0\n"), Contains("its header has no end"));
    CHECK_THAT(directory.error_of("ply\nformat morse 1.0\nend_header\n"), Contains("format \"morse\" is unknown"));
    CHECK_THAT(directory.error_of("ply\nformat ascii 1.0\nproperty int x\nend_header\n"),
               Contains("before any element"));
    CHECK_THAT(directory.error_of(head + "property half w\n" + faces), Contains("unknown type \"half\""));
    CHECK_THAT(directory.error_of(head + "end_header\n" + square), Contains("has no faces"));
    CHECK_THAT(directory.error_of(head + faces + square), Contains("face 0, counted from 0: the file ends before it"));
    CHECK_THAT(directory.error_of(head + faces + "0 0 0 1\n1 zero 0 0\n"),
               Contains("vertex 1") && Contains("is no number"));
    CHECK_THAT(directory.error_of(head + faces + "0 0 nan 1\n"), Contains("vertex 0") && Contains("finite"));
    CHECK_THAT(directory.error_of(head + faces + square + "3 0 1 4\n"), Contains("names vertex 4, but there are 4"));
    CHECK_THAT(directory.error_of(head + faces + square + "3 0 1 -1\n"), Contains("names vertex -1, which is none"));
    CHECK_THAT(directory.error_of(head + faces + square + "2 0 1\n"), Contains("fewer than three"));
    CHECK_THAT(directory.error_of("ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty int x\nend_header\n"),
               Contains("the file ends before it"));
    CHECK_THAT(directory.error_of("ply\nformat ascii 1.0\nelement vertex 9\nend_header\n"), Contains("no properties"));
}
