#include "surface_table.h"

#include "bvh.h"

namespace vkvol {

namespace {

struct Bounded {
    shared::SurfacePrimitive primitive;
    BvhBox box;
};

// Pieces of one surface.
class Pieces {
public:
    Pieces(std::uint32_t row, const glm::dvec3& origin, std::vector<shared::SurfacePrimitive>& planes,
           std::vector<Bounded>& bounded)
        : row_(row), origin_(origin), planes_(planes), bounded_(bounded) {}

    std::uint32_t operator()(const BallSurface& ball) const {
        add(SURFACE_SPHERE, ball.center, glm::vec3(0.0f), ball.radius);
        return SURFACE_SPHERE;
    }
    std::uint32_t operator()(const DiskSurface& disk) const {
        add(SURFACE_DISK, disk.center, disk.normal, disk.radius);
        return SURFACE_DISK;
    }
    std::uint32_t operator()(const PlaneSurface& plane) const {
        planes_.push_back({plane.point - origin_, row_, plane.normal, SURFACE_PLANE, glm::vec3(0.0f), 0});
        return SURFACE_PLANE;
    }
    std::uint32_t operator()(const RectangleSurface& r) const {
        return (*this)(TriangleSurface{{r.center - r.edge_u - r.edge_v, r.center + r.edge_u - r.edge_v,
                                        r.center + r.edge_u + r.edge_v, r.center - r.edge_u + r.edge_v},
                                       {{0, 1, 2}, {0, 2, 3}}});
    }
    std::uint32_t operator()(const MeshSurface&) const { return SURFACE_TRIANGLES; } // not loaded: none
    std::uint32_t operator()(const TriangleSurface& mesh) const {
        for (const glm::uvec3& t : mesh.triangles) {
            Bounded piece{{mesh.vertices[t.x] - origin_, row_, mesh.vertices[t.y] - origin_, SURFACE_TRIANGLES,
                           mesh.vertices[t.z] - origin_, 0},
                          {}};
            // One of no area has no normal, and no ray meets it.
            if (glm::length(glm::cross(piece.primitive.b - piece.primitive.a, piece.primitive.c - piece.primitive.a)) ==
                0.0f)
                continue;
            for (const glm::vec3& corner : {piece.primitive.a, piece.primitive.b, piece.primitive.c})
                piece.box.add(corner);
            bounded_.push_back(piece);
        }
        return SURFACE_TRIANGLES;
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

shared::SurfaceRow row_of(const Surface& surface) {
    const Material& material = surface.material;
    const bool is_glass = material.kind == MaterialKind::dielectric;
    shared::SurfaceRow row{};
    row.material = static_cast<std::uint32_t>(material.kind);
    row.color = material.color;
    row.emission = surface.emission;
    row.sides = surface.shines_both_ways ? 2u : 1u;
    row.eta = is_glass ? Rgb(material.ior) : material.eta;
    row.k = material.k;
    return row;
}

} // namespace

SurfaceTable make_surface_table(const std::vector<Surface>& surfaces, const glm::dvec3& origin) {
    SurfaceTable table;
    std::vector<Bounded> bounded;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Pieces pieces(static_cast<std::uint32_t>(i), origin, table.primitives, bounded);
        shared::SurfaceRow row = row_of(surfaces[i]);
        row.shape = std::visit(pieces, surfaces[i].shape);
        table.rows.push_back(row);
    }
    table.planes = static_cast<std::uint32_t>(table.primitives.size());
    std::vector<BvhBox> boxes;
    for (const Bounded& piece : bounded)
        boxes.push_back(piece.box);
    BoxTree tree = build_box_tree(boxes);
    for (const std::uint32_t i : tree.order)
        table.primitives.push_back(bounded[i].primitive);
    for (shared::BvhNode& node : tree.nodes)
        node.leaf += node.leaf != 0 ? 8 * table.planes : 0;
    table.nodes = std::move(tree.nodes);
    return table;
}

int material_bits(const std::vector<Surface>& surfaces) {
    int bits = 0;
    for (const Surface& surface : surfaces)
        bits |= 1 << static_cast<int>(surface.material.kind);
    return bits;
}

} // namespace vkvol
