// The surfaces of a scene as they are written. World space; lengths are world units.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
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

// By which part a transform may stretch what stays a ball or a disk: scene files have matrices of six digits.
inline constexpr double stretch_of_digits = 1e-5;

// Counterclockwise as seen from without, or from in front.
struct TriangleSurface {
    std::vector<glm::dvec3> vertices;
    std::vector<glm::uvec3> triangles;
    // At each triangle's corners, unit, as columns, of what it stands for; or empty.
    std::vector<glm::mat3> normals = {};
    // Where they are on a texture, as columns: across and upwards, (0, 0) its lower left and (1, 1) its upper right; or
    // empty.
    std::vector<glm::mat3x2> places = {};
    bool is_mesh = false; // as of a file: of glass it has to be closed

    // Its front to the other side, as after a mirror, which turns triangles inside out.
    void turn_about() {
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            std::swap(triangles[i].y, triangles[i].z);
            if (!normals.empty())
                std::swap(normals[i][1], normals[i][2]);
            if (!places.empty())
                std::swap(places[i][1], places[i][2]);
        }
    }
};

struct RectangleSurface {
    glm::dvec3 center{0.0};
    glm::dvec3 edge_u{0.5, 0.0, 0.0}, edge_v{0.0, 0.0, -0.5}; // halves of its edges, across each other; front: u x v

    TriangleSurface triangles() const {
        return {
            {center - edge_u - edge_v, center + edge_u - edge_v, center + edge_u + edge_v, center - edge_u + edge_v},
            {{0, 1, 2}, {0, 2, 3}},
            {},
            {{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 1}, {0, 1}}}};
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

enum class MaterialKind { diffuse, mirror, conductor, dielectric, coated, thin_dielectric };

inline constexpr double least_roughness = 1e-3;

// An image of colours, between the middles of whose texels they are interpolated linearly; it repeats without end.
struct Texture {
    int width = 0, height = 0;
    std::vector<glm::vec3> colors; // linear Rec.709, in [0, 1], rows top to bottom
    bool is_nearest = false;       // each texel has its colour up to its edges
};

struct Material {
    MaterialKind kind = MaterialKind::diffuse;
    Rgb color{0.5};   // share of the light that goes on, in [0, 1]; of a conductor times Fresnel's; of what is
                      // coated, below the coat
    double ior = 1.5; // of a dielectric: index of refraction of what it encloses over that around it; of a coat, and
                      // of a pane, which is thin; > 0
    Rgb eta{1.0}, k{0.0}; // of a conductor: its complex index, eta + i k
    double roughness = 0; // of a conductor or dielectric: alpha of GGX, in [least_roughness, 1]; 0: smooth
    std::filesystem::path texture =
        {}; // an image that multiplies the colour, of all but dielectrics and panes; or empty
    glm::dvec2 repeat{
        1.0}; // how many times it lies side by side across the shape, of a plane across a unit of the world; > 0
    std::shared_ptr<const Texture> image = {}; // once it is loaded; or what is of no file, a board of two colours
};

inline bool is_textured(const Material& material) {
    return material.image || !material.texture.empty();
}

// One that `ior` tells.
inline bool has_index(const Material& material) {
    return material.kind == MaterialKind::dielectric || material.kind == MaterialKind::coated ||
           material.kind == MaterialKind::thin_dielectric;
}

struct Surface {
    SurfaceShape shape;
    Material material;
    Rgb emission{0.0};             // radiance from its front, which is where its normal points to
    bool shines_both_ways = false; // from its back too
    glm::dmat4 transform{1.0};     // of a mesh's file; the others are where they say
    // Unit, x, y and z, of a ball, disk or plane, by which a texture lies on it: as on a globe whose poles are at y and
    // whose middle column at z; or with its columns along y, z being the normal.
    glm::dmat3 axes{1.0};
    std::string place; // "file:line:column", for messages; or empty
};

} // namespace vkvol
