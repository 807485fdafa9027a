// Meshes as files, as closed surfaces, and as hierarchies.
#include <catch2/catch.hpp>
#include <functional>

#include "bvh.h"
#include "error.h"
#include "mesh.h"
#include "support/test_directory.h"
#include "support/test_meshes.h"

using namespace vkvol;
using Catch::Contains;

namespace {

struct MeshDirectory : TestDirectory {
    Mesh load(const std::string& text) const { return load_mesh({{write("mesh.obj", text)}}); }
    std::string error(const std::string& text) const {
        try {
            load(text);
        } catch (const InputError& e) {
            CHECK_THAT(e.what(), Contains((path / "mesh.obj").string()));
            return e.what();
        }
        return "no error";
    }
};

const std::string cube_vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
const std::string cube_sides = "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const std::string cube = cube_vertices + "f 4 3 2 1\nf 5 6 7 8\n" + cube_sides;

double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3 t : mesh.triangles)
        sum += glm::dot(mesh.vertices[t.x], glm::cross(mesh.vertices[t.y], mesh.vertices[t.z])) / 6.0;
    return sum;
}

// A polygon that is not convex, as a prism: the letter L.
const std::string letter =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
    "f 6 5 4 3 2 1\nf 9 10 11 12 7 8\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";

} // namespace

TEST_CASE("an .obj file of quads, texture coordinates, groups and Windows line ends", "[mesh]") {
    const MeshDirectory directory;
    Mesh mesh = directory.load(cube);
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(volume(mesh) == Approx(1.0));
    CHECK(!mesh.diffuse);
    CHECK(mesh.warnings.empty());
    std::string windows;
    for (const char c : "# a cube\r\no cube\n" + cube)
        windows += c == '\n' ? "\r\n" : std::string(1, c);
    CHECK(volume(directory.load(windows)) == Approx(1.0));
    CHECK(volume(directory.load(cube_vertices +
                                "vt 0 0\nvn 0 0 1\ng a\nf 4/1/1 3/1/1 2/1/1 1/1/1\ng b\n"
                                "f -4//1 -3//1 -2//1 -1//1\n" +
                                cube_sides)) == Approx(1.0));
    // 17 digits survive.
    mesh = directory.load("v +1234567.8901234567 0 0\nv 1234568.5 0 0\nv 1234567.9 1 0\nv 1234567.9 0 1\n"
                          "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    CHECK(mesh.vertices[0].x == 1234567.8901234567);
}

TEST_CASE("an .obj file with comments, lines that go on, and a mark of UTF-8", "[mesh]") {
    const TestDirectory directory;
    const auto read = [&](const std::string& text) { return read_polygons(directory.write("a.obj", text)); };
    const Polygons plain = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    const Polygons written = read("\xef\xbb\xbfv 0 0 0 # first\r\nv 1 0 \\\r\n0\r\n#v 9 9 9\r\nv 0 1 0\r\nv 1 1 0\r\n"
                                  "f 1 2 3 # front\r\nf 2 \\ \r\n 4 \\\r\n3\r\n");
    CHECK(written.vertices == plain.vertices);
    CHECK(written.triangles == plain.triangles);
    // Not so in a comment, which may end with a path, nor in names.
    directory.write("a.mtl", "\xef\xbb\xbfnewmtl gold #1\nKd 1 0 0\nnewmtl  gold #2 \nmap_Kd C:\\t\\\nKd 1 0.5 0\n");
    const Polygons named =
        read("# from C:\\\nmtllib a.mtl\nv 0 0 0 # C:\\\nv 1 0 0\nv 0 1 0\nusemtl gold #2\nf 1 2 3\n");
    CHECK(named.vertices.size() == 3);
    CHECK(named.diffuse == Rgb(1.0, 0.5, 0.0));
    CHECK_THROWS_WITH(read("v 0 0 \\\n0\nv 1 x 0\n"), Catch::Contains("a.obj:3:")); // by the lines of the file
}

TEST_CASE("vertices at one position are welded, faces turned outward, slivers dropped or kept", "[mesh]") {
    const MeshDirectory directory;
    const Mesh box = directory.load(as_obj(make_box(glm::dvec3(-1.0), glm::dvec3(1.0), 4)));
    CHECK(box.vertices.size() == 6 * 16 + 2);
    CHECK(volume(box) == Approx(8.0));
    // Inside out, and far away.
    Mesh turned = make_box({-1.0, 1e4, 0.0}, {1.0, 1e4 + 1.0, 3.0}, 2);
    for (glm::uvec3& t : turned.triangles)
        std::swap(t.x, t.y);
    CHECK(volume(turned) == Approx(-6.0));
    CHECK(volume(directory.load(as_obj(turned))) == Approx(6.0));
    // Each body by itself.
    CHECK(volume(directory.load(as_obj(join(turned, make_box(glm::dvec3(0.0), glm::dvec3(1.0), 1))))) == Approx(7.0));
    // Inside another, turned the other way, it is a cavity; whichever way they are turned together.
    const Mesh shell = make_box(glm::dvec3(-1.0), glm::dvec3(1.0), 2),
               core = make_box(glm::dvec3(-0.5), glm::dvec3(0.5), 1),
               grain = make_box(glm::dvec3(-0.25), glm::dvec3(0.25), 1);
    const auto inside_out = [](Mesh mesh) {
        for (glm::uvec3& t : mesh.triangles)
            std::swap(t.x, t.y);
        return mesh;
    };
    CHECK(volume(directory.load(as_obj(join(shell, inside_out(core))))) == Approx(7.0));
    CHECK(volume(directory.load(as_obj(join(inside_out(shell), core)))) == Approx(7.0));
    CHECK(volume(directory.load(as_obj(join(shell, core)))) == Approx(9.0));
    CHECK(volume(directory.load(as_obj(join(inside_out(core), join(shell, grain))))) == Approx(7.125));
    // A face of two corners in one place, and one of three on a line that fills a gap.
    const std::string shared_edge = cube_vertices + "v 0 0 0\nf 4 3 2 1\nf 5 6 7 8\n" + cube_sides + "f 1 9 2\n";
    CHECK(directory.load(shared_edge).triangles.size() == 12);
    const std::string filled =
        cube_vertices +
        "v 0.5 0 0\nf 4 3 2 1\nf 5 6 7 8\nf 1 9 6 5\nf 9 2 6\nf 1 2 9\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    CHECK(directory.load(filled).triangles.size() == 14);
    CHECK(volume(directory.load(filled)) == Approx(1.0));
    CHECK(volume(directory.load(letter)) == Approx(3.0));
    // Two cubes that share a face, and so four triangles to some edges.
    const Mesh stacked = join(make_box(glm::dvec3(0.0), glm::dvec3(1.0), 1), make_box({0, 0, 1}, {1, 1, 2}, 1));
    CHECK(volume(directory.load(as_obj(stacked))) == Approx(2.0));
}

TEST_CASE("polygons that are not convex are covered, and nothing else", "[mesh]") {
    const MeshDirectory directory;
    // All triangles face as the polygon does, and their areas sum up to its.
    const auto area = [](const Polygons& faces, std::size_t from, std::size_t count, const glm::dvec3& normal) {
        double sum = 0.0;
        for (std::size_t i = from; i < from + count; ++i) {
            const glm::uvec3 t = faces.triangles[i];
            const glm::dvec3 a = faces.vertices[t.x];
            const double part = 0.5 * glm::dot(normal, glm::cross(faces.vertices[t.y] - a, faces.vertices[t.z] - a));
            CHECK(part > 0.0);
            sum += part;
        }
        return sum;
    };
    const Polygons of_letter = read_polygons(directory.write("letter.obj", letter));
    CHECK(area(of_letter, 0, 4, {0, 0, -1}) == Approx(3.0));
    CHECK(area(of_letter, 4, 4, {0, 0, 1}) == Approx(3.0));
    // A star, whose faces come before its vertices.
    const std::string star = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                             "element vertex 8\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                             "8 0 1 2 3 4 5 6 7\n3 0 0\n1 0 1\n0 0 3\n-1 0 1\n-3 0 0\n-1 0 -1\n0 0 -3\n1 0 -1\n";
    CHECK(area(read_polygons(directory.write("star.ply", star)), 0, 6, {0, -1, 0}) == Approx(12.0));
    // A wall, whose window is small and cut in from its edge.
    const std::string wall = "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 50 100 0\nv 50 50 0\nv 50.2 50 0\nv 50.2 49.8 0\n"
                             "v 50 49.8 0\nv 50 50 0\nv 50 100 0\nv 0 100 0\nf 1 2 3 4 5 6 7 8 9 10 11\n";
    const Polygons of_wall = read_polygons(directory.write("wall.obj", wall));
    double covered = 0.0;
    for (const glm::uvec3& t : of_wall.triangles)
        covered += 0.5 * glm::length(glm::cross(of_wall.vertices[t.y] - of_wall.vertices[t.x],
                                                of_wall.vertices[t.z] - of_wall.vertices[t.x]));
    CHECK(covered == Approx(1e4 - 0.04).epsilon(1e-9));
}

TEST_CASE("materials", "[mesh]") {
    const MeshDirectory directory;
    directory.write("two.mtl", "newmtl red\nKd 0.75 0.25 0.125\nnewmtl blue\nKd 0 0 1\n");
    const std::string head = "mtllib two.mtl\n" + cube_vertices;
    const std::string caps = "f 4 3 2 1\nf 5 6 7 8\n";
    Mesh mesh = directory.load(head + "usemtl red\n" + caps + cube_sides);
    REQUIRE(mesh.diffuse);
    CHECK(glm::length(*mesh.diffuse - Rgb(0.75, 0.25, 0.125)) < 1e-6);
    CHECK(mesh.warnings.empty());
    mesh = directory.load(head + "usemtl red\n" + caps + "usemtl blue\n" + cube_sides);
    CHECK(glm::length(*mesh.diffuse - Rgb(0.75, 0.25, 0.125)) < 1e-6);
    REQUIRE(mesh.warnings.size() == 1);
    CHECK_THAT(mesh.warnings[0], Contains("Kd"));
    // Of concern to textures alone.
    mesh = directory.load("vt 0 1e39\n" + head + "usemtl red\n" + caps + cube_sides);
    CHECK(mesh.warnings.empty());
    const std::string placed = "vt 0 1e39\nvt 1 1\n" + cube_vertices + "f 4/1 3/2 2/2 1/2\n" + cube_sides;
    const Polygons textured = read_polygons(directory.write("placed.obj", placed));
    REQUIRE(textured.place_warnings.size() == 2);
    CHECK_THAT(textured.place_warnings[0], Contains("vt 0 inf counts as 0 0"));
    CHECK_THAT(textured.place_warnings[1], Contains("8 of its 10 triangles do not say where on a texture"));
    const std::string beyond = "vt 0 0\nvt 1 1\nvt 0 1\n" + cube_vertices + "f 4/1 3/2 2/3\nf 4/1 2/7 1/3\n";
    const Polygons misnumbered = read_polygons(directory.write("beyond.obj", beyond));
    REQUIRE(misnumbered.place_warnings.size() == 1);
    CHECK_THAT(misnumbered.place_warnings[0], Contains("1 of its 2 triangles do not say where on a texture"));
    CHECK(!directory.load("mtllib missing.mtl\n" + cube_vertices + "usemtl red\n" + caps + cube_sides).diffuse);
    directory.write("my scene.mtl", "newmtl red\nKd 0.75 0.25 0.125\n");
    mesh = directory.load("mtllib my scene.mtl\n" + cube_vertices + "usemtl red\n" + caps + cube_sides);
    CHECK(mesh.diffuse);
    CHECK(mesh.warnings.empty());
    // Several files: the first face of all.
    const auto red = directory.write("red.obj", head + "usemtl red\n" + caps + cube_sides);
    const auto plain = directory.write("plain.obj", as_obj(make_box({5, 0, 0}, {6, 2, 1}, 2)));
    mesh = load_mesh({{red, plain}});
    CHECK(volume(mesh) == Approx(3.0));
    CHECK(mesh.diffuse);
    CHECK(mesh.warnings.size() == 1);
}

TEST_CASE("what is no closed surface is refused, with the remedy", "[mesh]") {
    const MeshDirectory directory;
    CHECK_THAT(directory.error(cube_vertices + "f 4 3 2 1\n" + cube_sides),
               Contains("4 edges") && Contains("close the"));
    CHECK_THAT(directory.error(cube_vertices + "f 4 3 2 1\nf 8 7 6 5\n" + cube_sides),
               Contains("4 edges") && Contains("Recalculate Outside"));
    CHECK_THAT(directory.error("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\nf 3 4 2 1\n"),
               Contains("encloses nothing") && Contains("Solidify"));
    CHECK_THAT(directory.error(cube + "f 1 2 7\n"), Contains("3 edges"));
    CHECK_THAT(directory.error(cube + "f 1 2 9\n"), Contains("vertex 9") && Contains("8 vertices"));
    CHECK_THAT(directory.error(cube + "f 1 2 -9\n"), Contains("vertex -9"));
    CHECK_THAT(directory.error(cube + "f 0 1 2\n"), Contains("vertex 0"));
    CHECK_THAT(directory.error(cube + "f 1 2\n"), Contains("fewer than three"));
    for (const std::string number : {"nan", "inf", "1e400", "-1e12", "abc", ""})
        CHECK_THAT(directory.error("# one\nv 0 1 " + number + "\n" + cube), Contains(":2:") && Contains("finite"));
    CHECK_THAT(directory.error(""), Contains("no faces"));
    CHECK_THAT(directory.error(cube_vertices), Contains("no faces"));
    CHECK_THAT(directory.error(std::string("\x7f"
                                           "ELF\0\1\2 garbage \xff\n f\n",
                                           22)),
               Contains("no faces"));
    CHECK_THAT(directory.error("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), Contains("degenerate"));
    CHECK_THROWS_WITH(load_mesh({{directory.path / "none.obj"}}), Contains("none.obj") && Contains("check the path"));
    CHECK_THROWS_WITH(load_mesh({{directory.path}}), Contains("directory"));
    CHECK_THROWS_AS(load_mesh({}), InputError);
}

TEST_CASE("the hierarchy holds every triangle once, within its boxes", "[mesh]") {
    const int level = GENERATE(0, 2, 6); // up to 81920 triangles
    const Mesh mesh = make_icosphere(level);
    const glm::dvec3 origin(0.5, -3.0, 1e5);
    const Bvh bvh = build_bvh(mesh, origin);
    REQUIRE(bvh.triangles.size() == 3 * mesh.triangles.size());
    std::size_t next = 0, steps = 0;
    std::function<std::uint32_t(std::uint32_t)> visit = [&](std::uint32_t i) { // returns where its subtree ends
        const shared::BvhNode& node = bvh.nodes[i];
        ++steps;
        if (node.leaf != 0u) {
            REQUIRE(node.leaf / 8 == next);
            REQUIRE(node.leaf % 8 > 0u);
            for (std::uint32_t k = 0; k < 3 * (node.leaf % 8); ++k) {
                const glm::vec3 v = bvh.triangles[3 * next + k];
                REQUIRE((glm::all(glm::lessThanEqual(node.low, v)) && glm::all(glm::lessThanEqual(v, node.high))));
            }
            next += node.leaf % 8;
            REQUIRE(node.skip == i + 1);
        } else {
            for (std::uint32_t child = i + 1; child != node.skip;) {
                REQUIRE(child < node.skip);
                const shared::BvhNode& c = bvh.nodes[child];
                REQUIRE(
                    (glm::all(glm::lessThanEqual(node.low, c.low)) && glm::all(glm::lessThanEqual(c.high, node.high))));
                child = visit(child);
            }
        }
        return node.skip;
    };
    CHECK(visit(0) == bvh.nodes.size());
    CHECK(steps == bvh.nodes.size());
    CHECK(next == mesh.triangles.size());
    CHECK(glm::length(glm::dvec3(bvh.nodes[0].low) - (glm::dvec3(-1.0) - origin)) < 0.3);
}
