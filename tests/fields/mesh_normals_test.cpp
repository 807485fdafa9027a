// Which normals the corners of a mesh's faces have.
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "support/test_directory.h"
#include "support/test_meshes.h"
#include "surface_mesh.h"

using namespace vkvol;

namespace {

TriangleSurface loaded(const std::filesystem::path& file, MeshNormals normals = MeshNormals::of_file,
                       const glm::dmat4& transform = glm::dmat4(1.0), MaterialKind kind = MaterialKind::diffuse) {
    Scene scene;
    Surface& surface = scene.surfaces.emplace_back();
    surface.shape = MeshSurface{file, normals};
    surface.transform = transform;
    surface.material.kind = kind;
    return std::get<TriangleSurface>(with_surface_files(scene).surfaces.front().shape);
}

void check_near(const glm::vec3& a, const glm::dvec3& b) {
    CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
    CHECK(glm::distance(glm::dvec3(a), b) < 1e-5); // files have six digits
}

// Two faces, one in the plane of x and y, one in that of x and z, with the x axis in common.
const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string roof = corners + "f 1 2 3\nf 1 4 2\n";

} // namespace

TEST_CASE("normals are those of the file, turned with the mesh and to the side of its faces", "[cpu][mesh][surfaces]") {
    const TestDirectory directory;
    const auto file = directory.write("a.obj", corners + "vn 0.6 0 0.8\nvn 0 0 -2\nf 1//1 2//2 3\n");
    const TriangleSurface mesh = loaded(file);
    REQUIRE(mesh.normals.size() == 1);
    check_near(mesh.normals[0][0], {0.6, 0.0, 0.8});
    check_near(mesh.normals[0][1], {0.0, 0.0, 1.0}); // it says the other side
    check_near(mesh.normals[0][2], {0.0, 0.0, 1.0}); // it says nothing
    // Normals are not moved as directions are.
    const glm::dmat4 stretched = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0, 1.0, 1.0));
    check_near(loaded(file, MeshNormals::of_file, stretched).normals[0][0], glm::normalize(glm::dvec3(0.3, 0.0, 0.8)));
    // Mirrored, corners change places, and outside is still outside.
    const glm::dmat4 mirrored = glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, -1.0, 1.0));
    const TriangleSurface other = loaded(file, MeshNormals::of_file, mirrored);
    check_near(other.normals[0][0], {0.6, 0.0, 0.8});
    check_near(other.normals[0][1], {0.0, 0.0, 1.0});
    CHECK(loaded(file, MeshNormals::flat).normals.empty());
    CHECK(loaded(directory.write("b.obj", roof)).normals.empty());
}

TEST_CASE("smooth normals are the means of faces about a corner", "[cpu][mesh][surfaces]") {
    const TestDirectory directory;
    const TriangleSurface mesh = loaded(directory.write("roof.obj", roof), MeshNormals::smooth);
    REQUIRE(mesh.normals.size() == 2);
    const glm::dvec3 both = glm::normalize(glm::dvec3(0.0, 1.0, 1.0));
    check_near(mesh.normals[0][0], both);
    check_near(mesh.normals[0][1], both);
    check_near(mesh.normals[0][2], {0.0, 0.0, 1.0});
    check_near(mesh.normals[1][1], {0.0, 1.0, 0.0});
    // So they are where each face has corners of its own, unless they stand at right angles or more.
    const std::string tilted = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -0.6 0.8\nv 0 0 0\nv 1 0 0\n";
    const TriangleSurface bent =
        loaded(directory.write("bent.obj", tilted + "f 1 2 3\nf 5 4 6\n"), MeshNormals::smooth);
    check_near(bent.normals[0][0], glm::normalize(glm::dvec3(0.0, 0.8, 1.6)));
    check_near(bent.normals[1][2], glm::normalize(glm::dvec3(0.0, 0.8, 1.6)));
    // A sheet with a side of its own on either, which looks the other way.
    const TriangleSurface sheet = loaded(
        directory.write("sheet.obj", corners + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 5 7 6\n"), MeshNormals::smooth);
    check_near(sheet.normals[0][0], {0.0, 0.0, 1.0});
    check_near(sheet.normals[1][0], {0.0, 0.0, -1.0});
    const std::string split = corners + "v 0 0 0\nv 1 0 0\n" + "f 1 2 3\nf 5 4 6\n";
    const TriangleSurface other = loaded(directory.write("split.obj", split), MeshNormals::smooth);
    REQUIRE(other.normals.size() == 2);
    check_near(other.normals[0][0], {0.0, 0.0, 1.0});
    check_near(other.normals[1][2], {0.0, 1.0, 0.0});
    check_near(other.normals[1][1], {0.0, 1.0, 0.0});
}

TEST_CASE("normals of a .ply file, and of glass", "[cpu][mesh][surfaces]") {
    const TestDirectory directory;
    const std::string ball = as_obj(make_icosphere(1));
    std::string normals;
    for (const glm::dvec3& vertex : make_icosphere(1).vertices) // of a ball they are its vertices
        normals +=
            "vn " + std::to_string(vertex.x) + ' ' + std::to_string(vertex.y) + ' ' + std::to_string(vertex.z) + '\n';
    std::string faces = ball.substr(ball.find('f'));
    for (std::size_t at = 0; (at = faces.find(' ', at)) != std::string::npos;) {
        const std::string index = faces.substr(at + 1, faces.find_first_of(" \n", at + 1) - at - 1);
        faces.insert(at + 1 + index.size(), "//" + index);
        at += 1 + index.size();
    }
    const auto file = directory.write("ball.obj", ball.substr(0, ball.find('f')) + normals + faces);
    const glm::dmat4 inside_out = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0));
    for (const MaterialKind kind : {MaterialKind::diffuse, MaterialKind::dielectric})
        for (const glm::dmat4& map : {glm::dmat4(1.0), inside_out}) {
            const TriangleSurface mesh = loaded(file, MeshNormals::of_file, map, kind);
            REQUIRE(mesh.normals.size() == mesh.triangles.size());
            for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
                for (int corner = 0; corner < 3; ++corner)
                    check_near(mesh.normals[i][corner], glm::normalize(mesh.vertices[mesh.triangles[i][corner]]));
        }
    const TriangleSurface ply = loaded(directory.write(
        "one.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
                   "property list uchar int vertex_indices\nend_header\n"
                   "0 0 0 0 0 1\n1 0 0 0.6 0 0.8\n0 1 0 0 3 4\n3 0 1 2\n"));
    check_near(ply.normals.at(0)[1], {0.6, 0.0, 0.8});
    check_near(ply.normals.at(0)[2], {0.0, 0.6, 0.8});
}

TEST_CASE("normals that a file names and does not have are told", "[cpu][mesh][surfaces]") {
    const TestDirectory directory;
    const auto warnings = [&](const std::string& text) {
        Scene scene;
        scene.surfaces.emplace_back().shape = MeshSurface{directory.write("a.obj", corners + text)};
        return with_surface_files(scene).warnings;
    };
    const std::string normal = "vn 0 0 1\n", rest = "f 1//1 2//1 4//1\n";
    for (const char* face : {"f 1//1 2//2 3//1\n", "f 1//1 2//-2 3//1\n"}) {
        const std::vector<std::string> told = warnings(normal + rest + face);
        CAPTURE(face);
        REQUIRE(told.size() == 1);
        CHECK_THAT(told.front(), Catch::Contains("1 of its 2 triangles name a normal that is not among its 1"));
    }
    CHECK(warnings("f 1//1 2//1 3//1\n").size() == 1); // there are none
    for (const char* face : {"f 1//-1 2//1 3//1\n", "f 1 2 3\n", "f 1//1 2 3\n"})
        CHECK(warnings(normal + rest + face).empty());
}
