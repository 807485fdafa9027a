#include "surface_table.h"

#include <cmath>

#include "bvh.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

struct Bounded {
    shared::SurfacePrimitive primitive;
    BvhBox box;
    const glm::mat3* normals = nullptr; // of its corners, as columns
};

// Pieces of one surface.
class Pieces {
public:
    Pieces(std::uint32_t row, const glm::dvec3& origin, std::vector<shared::SurfacePrimitive>& planes,
           std::vector<Bounded>& bounded)
        : row_(row), origin_(origin), planes_(planes), bounded_(bounded) {}

    void operator()(const BallSurface& ball) const { add(SURFACE_SPHERE, ball.center, glm::vec3(0.0f), ball.radius); }
    void operator()(const DiskSurface& disk) const { add(SURFACE_DISK, disk.center, disk.normal, disk.radius); }
    void operator()(const PlaneSurface& plane) const {
        planes_.push_back({plane.point - origin_, row_, plane.normal, SURFACE_PLANE, glm::vec3(0.0f), 0});
    }
    void operator()(const RectangleSurface& rectangle) const { (*this)(rectangle.triangles()); }
    void operator()(const MeshSurface&) const {} // not loaded: none
    void operator()(const TriangleSurface& mesh) const {
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const glm::uvec3 t = mesh.triangles[i];
            Bounded piece{{mesh.vertices[t.x] - origin_, row_, mesh.vertices[t.y] - origin_, SURFACE_TRIANGLES,
                           mesh.vertices[t.z] - origin_, 0},
                          {},
                          mesh.normals.empty() ? nullptr : &mesh.normals[i]};
            // One of no area has no normal, and no ray meets it.
            if (glm::length(glm::cross(piece.primitive.b - piece.primitive.a, piece.primitive.c - piece.primitive.a)) ==
                0.0f)
                continue;
            for (const glm::vec3& corner : {piece.primitive.a, piece.primitive.b, piece.primitive.c})
                piece.box.add(corner);
            bounded_.push_back(piece);
        }
    }

private:
    // The box errs by the rounding of its middle and radius.
    void add(std::uint32_t shape, const glm::dvec3& center, const glm::dvec3& normal, double radius) const {
        const glm::vec3 middle = center - origin_;
        const float r = static_cast<float>(radius);
        Bounded piece{{middle, row_, normal, shape, {r, 0.0f, 0.0f}, 0}, {}};
        piece.box.add(middle - r * 1.000001f);
        piece.box.add(middle + r * 1.000001f);
        bounded_.push_back(piece);
    }

    std::uint32_t row_;
    const glm::dvec3& origin_;
    std::vector<shared::SurfacePrimitive>& planes_;
    std::vector<Bounded>& bounded_;
};

std::uint32_t code_of(const Material& material) {
    switch (material.kind) {
    case MaterialKind::mirror:
        return MATERIAL_MIRROR;
    case MaterialKind::conductor:
        return material.roughness > 0.0 ? MATERIAL_ROUGH_CONDUCTOR : MATERIAL_CONDUCTOR;
    case MaterialKind::dielectric:
        return material.roughness > 0.0 ? MATERIAL_ROUGH_DIELECTRIC : MATERIAL_DIELECTRIC;
    case MaterialKind::coated:
        return MATERIAL_COATED;
    case MaterialKind::diffuse:
        break;
    }
    return MATERIAL_DIFFUSE;
}

// Of even light from within a boundary of this index, what it throws back. What passes of such light from outside, T,
// is found by Fresnel's equations, since from there no angle throws all back; from within T / ior^2 passes.
double thrown_back(double ior) {
    constexpr int n = 4096;
    double passes = 0.0;
    for (int i = 0; i < n; ++i) {
        const double cosine = (i + 0.5) / n,
                     beyond = std::sqrt(std::max(1.0 - (1.0 - cosine * cosine) / (ior * ior), 0.0));
        const double parallel = (ior * cosine - beyond) / (ior * cosine + beyond);
        const double across = (cosine - ior * beyond) / (cosine + ior * beyond);
        passes += 2.0 * cosine * (1.0 - 0.5 * (parallel * parallel + across * across)) / n;
    }
    return 1.0 - passes / (ior * ior);
}

shared::SurfaceRow row_of(const Surface& surface) {
    const Material& material = surface.material;
    const bool has_ior = material.kind == MaterialKind::dielectric || material.kind == MaterialKind::coated;
    shared::SurfaceRow row{};
    row.material = code_of(material);
    row.roughness = static_cast<float>(material.roughness);
    row.color = material.color;
    row.emission = surface.emission;
    row.sides = surface.shines_both_ways ? 2u : 1u;
    row.eta = has_ior ? Rgb(material.ior) : material.eta;
    row.k = material.kind == MaterialKind::coated ? Rgb(thrown_back(material.ior), 0.0, 0.0) : material.k;
    return row;
}

} // namespace

SurfaceTable make_surface_table(const std::vector<Surface>& surfaces, const glm::dvec3& origin) {
    SurfaceTable table;
    std::vector<Bounded> bounded;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Pieces pieces(static_cast<std::uint32_t>(i), origin, table.primitives, bounded);
        std::visit(pieces, surfaces[i].shape);
        table.rows.push_back(row_of(surfaces[i]));
    }
    table.planes = static_cast<std::uint32_t>(table.primitives.size());
    std::vector<BvhBox> boxes;
    for (const Bounded& piece : bounded)
        boxes.push_back(piece.box);
    BoxTree tree = build_box_tree(boxes);
    for (const std::uint32_t i : tree.order)
        table.primitives.push_back(bounded[i].primitive);
    const std::size_t first = table.primitives.size() - tree.order.size();
    table.met = static_cast<std::uint32_t>(table.primitives.size());
    for (std::size_t at = 0; at < tree.order.size(); ++at) // behind all that rays meet
        if (const glm::mat3* normals = bounded[tree.order[at]].normals) {
            table.primitives[first + at].normals = static_cast<std::uint32_t>(table.primitives.size());
            table.primitives.push_back({(*normals)[0], 0, (*normals)[1], 0, (*normals)[2], 0});
        }
    for (shared::BvhNode& node : tree.nodes)
        node.leaf += node.leaf != 0 ? 8 * table.planes : 0;
    table.nodes = std::move(tree.nodes);
    return table;
}

int material_bits(const std::vector<Surface>& surfaces) {
    int bits = 0;
    for (const Surface& surface : surfaces)
        bits |= 1 << code_of(surface.material);
    for (const Surface& surface : surfaces)
        if (const auto* mesh = std::get_if<TriangleSurface>(&surface.shape))
            bits |= mesh->normals.empty() ? 0 : 1 << SMOOTH_FACES;
    return bits;
}

} // namespace vkvol
