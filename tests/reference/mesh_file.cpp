// In double precision and under a name of its own, so as not to meet the library's single-precision build.
#define tinyobj tinyobj_double
#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <tiny_obj_loader.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <stdexcept>

#include "reference_mesh.h"

namespace reference {

namespace {

using Triangles = std::vector<std::array<glm::dvec3, 3>>;

double enclosed_volume(const Triangles& triangles) {
    double six_volumes = 0.0;
    for (const auto& [a, b, c] : triangles) // from a corner of the mesh, not from a far origin
        six_volumes += glm::dot(a - triangles[0][0], glm::cross(b - triangles[0][0], c - triangles[0][0]));
    return six_volumes / 6.0;
}

void add(Mesh& mesh, const std::filesystem::path& path) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromFile(path.string()))
        throw std::runtime_error(path.string() + ": cannot be read: " + reader.Error());
    const std::vector<double>& vertices = reader.GetAttrib().vertices;
    Triangles triangles;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        const auto corner = [&](std::size_t i) {
            const int v = shape.mesh.indices[i].vertex_index;
            return glm::dvec3(vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]);
        };
        for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3)
            triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
    }
    if (triangles.empty())
        throw std::runtime_error(path.string() + ": has no triangles");
    if (enclosed_volume(triangles) < 0.0)
        for (auto& triangle : triangles)
            std::swap(triangle[1], triangle[2]);
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    if (const auto& materials = reader.GetMaterials(); !mesh.diffuse && !materials.empty())
        mesh.diffuse = {materials[0].diffuse[0], materials[0].diffuse[1], materials[0].diffuse[2]};
}

} // namespace

Mesh load_mesh(const vkvol::MeshFiles& files) {
    Mesh mesh;
    for (const std::filesystem::path& path : files.paths)
        add(mesh, path);
    return mesh;
}

} // namespace reference
