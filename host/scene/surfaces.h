// The surfaces of a scene as they are written. World space; lengths are world units.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <variant>
#include <vector>

#include "lights.h"

namespace vkvol {

struct BallSurface {
    glm::dvec3 center{0.0};
    double radius = 1.0; // > 0
};

struct DiskSurface {
    glm::dvec3 center{0.0};
    glm::dvec3 normal{0.0, 1.0, 0.0}; // unit
    double radius = 1.0;              // > 0
};

// Counterclockwise as seen from without, or from in front.
struct TriangleSurface {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
    // At each triangle's corners, unit, as columns, of what it stands for; or empty.
    std::vector<glm::mat3> normals = {};
};

struct RectangleSurface {
    glm::dvec3 center{0.0};
    glm::dvec3 edge_u{0.5, 0.0, 0.0}, edge_v{0.0, 0.0, -0.5}; // halves of its edges, across each other; front: u x v

    TriangleSurface triangles() const {
        return {
            {center - edge_u - edge_v, center + edge_u - edge_v, center + edge_u + edge_v, center - edge_u + edge_v},
            {{0, 1, 2}, {0, 2, 3}}};
    }
};

// Without end.
struct PlaneSurface {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0, 1.0, 0.0}; // unit
};

// What a mesh takes for its normals: those of its file, where it has some; of its faces; or at corners the means of
// faces about them.
enum class MeshNormals { of_file, flat, smooth };

struct MeshSurface {
    std::filesystem::path file; // .obj or .ply
    MeshNormals normals = MeshNormals::of_file;
};

using SurfaceShape =
    std::variant<BallSurface, DiskSurface, RectangleSurface, PlaneSurface, TriangleSurface, MeshSurface>;

enum class MaterialKind { diffuse, mirror, conductor, dielectric, coated };

inline constexpr double least_roughness = 1e-3;

struct Material {
    MaterialKind kind = MaterialKind::diffuse;
    Rgb color{0.5};   // share of the light that goes on, in [0, 1]; of a conductor times Fresnel's; of what is
                      // coated, below the coat
    double ior = 1.5; // of a dielectric: index of refraction of what it encloses over that around it; of a coat; > 0
    Rgb eta{1.0}, k{0.0}; // of a conductor: its complex index, eta + i k
    double roughness = 0; // of a conductor or dielectric: alpha of GGX, in [least_roughness, 1]; 0: smooth
};

struct Surface {
    SurfaceShape shape;
    Material material;
    Rgb emission{0.0};             // radiance from its front, which is where its normal points to
    bool shines_both_ways = false; // from its back too
    glm::dmat4 transform{1.0};     // of a mesh's file; the others are where they say
    std::string place;             // "file:line:column", for messages; or empty
};

} // namespace vkvol
