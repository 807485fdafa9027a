#include "surface_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "bvh.h"
#include "shared/constants.h"

namespace vkvol {

static_assert(SMOOTH_FACES > MATERIAL_THIN_DIELECTRIC, "bits of one number");
static_assert(sizeof(shared::SurfaceRow) == SURFACE_ROW_TEXELS * 16, "texels, as surface_point.glsl reads them");

namespace {

struct Piece {
    shared::SurfacePrimitive primitive;
    BvhBox box;
    const glm::mat3* normals = nullptr;                // of its corners, as columns
    const glm::mat3x2* places = nullptr;               // of these on a texture
    std::optional<shared::SurfacePrimitive> axes = {}; // by which a texture lies on it
};

// Pieces of one surface.
class SurfacePieces {
public:
    SurfacePieces(std::uint32_t row, const Surface& surface, const glm::dvec3& origin, std::vector<Piece>& planes,
                  std::vector<Piece>& bounded)
        : row_(row), surface_(surface), origin_(origin), planes_(planes), bounded_(bounded) {}

    void operator()(const BallSurface& ball) const {
        add(SURFACE_SPHERE, ball.center, glm::vec3(0.0f), ball.radius, axes(1.0, 0.0));
    }
    void operator()(const DiskSurface& disk) const {
        add(SURFACE_DISK, disk.center, disk.normal, disk.radius, axes(0.5 / disk.radius, 0.5));
    }
    // By its point that is nearest to the origin: hits are known as well as numbers of that point's size are. A texture
    // begins where it did, but for whole ones.
    void operator()(const PlaneSurface& plane) const {
        const glm::dvec3 point = plane.point - origin_, foot = plane.normal * glm::dot(plane.normal, point);
        Piece piece{
            {foot, row_, plane.normal, SURFACE_PLANE, glm::vec3(0.0f), 0}, {}, nullptr, nullptr, axes(1.0, 0.0)};
        if (piece.axes) {
            const glm::dvec2 apart(glm::dot(surface_.axes[0], foot - point), glm::dot(surface_.axes[1], foot - point));
            piece.axes->c = glm::dvec3(glm::fract(apart * surface_.material.repeat) / surface_.material.repeat, 0.0);
        }
        planes_.push_back(piece);
    }
    void operator()(const RectangleSurface& rectangle) const {
        static const TriangleSurface flat = RectangleSurface().triangles(); // whose places stay
        TriangleSurface triangles = rectangle.triangles();
        const std::size_t first = bounded_.size();
        (*this)(triangles);
        for (std::size_t i = first; i < bounded_.size(); ++i)
            bounded_[i].places = bounded_[i].places ? &flat.places[i - first] : nullptr;
    }
    void operator()(const MeshSurface&) const {} // not loaded: none
    void operator()(const TriangleSurface& mesh) const {
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const glm::uvec3 t = mesh.triangles[i];
            const bool has_places = surface_.material.image && !mesh.places.empty();
            Piece piece{{mesh.vertices[t.x] - origin_, row_, mesh.vertices[t.y] - origin_, SURFACE_TRIANGLES,
                         mesh.vertices[t.z] - origin_, 0},
                        {},
                        mesh.normals.empty() ? nullptr : &mesh.normals[i],
                        has_places ? &mesh.places[i] : nullptr};
            // One of no area has no normal, and no ray meets it.
            const glm::vec3 u = piece.primitive.b - piece.primitive.a, v = piece.primitive.c - piece.primitive.a;
            const glm::vec3 longest = glm::max(glm::abs(u), glm::abs(v));
            const float scale = 1.0f / std::max({longest.x, longest.y, longest.z, 1e-30f}); // as kernels have it
            if (glm::cross(scale * u, scale * v) == glm::vec3(0.0f))
                continue;
            piece.box = box_of(piece.primitive);
            bounded_.push_back(piece);
        }
    }

private:
    void add(std::uint32_t shape, const glm::dvec3& center, const glm::dvec3& normal, double radius,
             std::optional<shared::SurfacePrimitive> axes) const {
        const glm::vec3 middle = center - origin_;
        const float r = static_cast<float>(radius);
        Piece piece{{middle, row_, normal, shape, {r, 0.0f, 0.0f}, 0}, {}, nullptr, nullptr, axes};
        piece.box = box_of(piece.primitive);
        bounded_.push_back(piece);
    }

    // Axes of a shape that has a texture. Flat ones have x and y alone: a place on the texture is how far along them it
    // is, scaled, and from where.
    std::optional<shared::SurfacePrimitive> axes(double scale, double from) const {
        if (!surface_.material.image)
            return std::nullopt;
        const bool is_ball = std::holds_alternative<BallSurface>(surface_.shape);
        const glm::dmat3 scaled = surface_.axes * scale;
        return shared::SurfacePrimitive{scaled[0], 0, scaled[1], DETAIL_AXES, is_ball ? scaled[2] : glm::dvec3(from),
                                        0};
    }

    std::uint32_t row_;
    const Surface& surface_;
    const glm::dvec3& origin_;
    std::vector<Piece>& planes_;
    std::vector<Piece>& bounded_;
};

// Behind all that rays meet. Normals say where places are.
void add_details(const Piece& piece, std::size_t i, std::vector<shared::SurfacePrimitive>& primitives) {
    const auto here = static_cast<std::uint32_t>(primitives.size());
    if (piece.normals || piece.places || piece.axes)
        primitives[i].details = here;
    if (const glm::mat3* n = piece.normals)
        primitives.push_back({(*n)[0], piece.places ? here + 1 : 0, (*n)[1], DETAIL_NORMALS, (*n)[2], 0});
    if (const glm::mat3x2* p = piece.places)
        primitives.push_back({{(*p)[0], 0.0f}, 0, {(*p)[1], 0.0f}, DETAIL_PLACES, {(*p)[2], 0.0f}, 0});
    if (piece.axes)
        primitives.push_back(*piece.axes);
}

// Each after what it is; those of the same image and repeats once.
class Textures {
public:
    Textures(std::uint32_t first, std::vector<glm::vec4>& texels) : first_(first), texels_(texels) {}

    std::uint32_t row_of(const Material& material) {
        if (!material.image)
            return 0;
        const auto [found, is_new] =
            rows_.try_emplace(std::tuple(material.image.get(), material.repeat.x, material.repeat.y),
                              first_ + static_cast<std::uint32_t>(texels_.size()) + 1);
        if (is_new) {
            const int width = material.image->width;
            texels_.emplace_back(material.image->is_nearest ? -width : width, material.image->height, material.repeat.x,
                                 material.repeat.y);
            for (const glm::vec3& color : material.image->colors)
                texels_.emplace_back(color, 0.0f);
        }
        return found->second;
    }

private:
    std::uint32_t first_;
    std::vector<glm::vec4>& texels_;
    std::map<std::tuple<const Texture*, double, double>, std::uint32_t> rows_;
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
    case MaterialKind::thin_dielectric:
        return MATERIAL_THIN_DIELECTRIC;
    case MaterialKind::diffuse:
        break;
    }
    return MATERIAL_DIFFUSE;
}

// Share of diffuse light from inside that a boundary of this index reflects back in. What passes of such light from
// outside, T, is found by Fresnel's equations, since from there no angle throws all back; from within T / ior^2 passes.
double internal_diffuse_reflectance(double ior) {
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
    const bool has_ior = has_index(material);
    shared::SurfaceRow row{};
    row.material = code_of(material);
    row.roughness = static_cast<float>(material.roughness);
    row.color = material.color;
    row.emission = surface.emission;
    row.sides = surface.shines_both_ways ? 2u : 1u;
    row.eta = has_ior ? Rgb(material.ior) : material.eta;
    row.k =
        material.kind == MaterialKind::coated ? Rgb(internal_diffuse_reflectance(material.ior), 0.0, 0.0) : material.k;
    return row;
}

} // namespace

SurfaceTable make_surface_table(const std::vector<Surface>& surfaces, const glm::dvec3& origin,
                                std::uint32_t first_texel) {
    SurfaceTable table;
    Textures textures(first_texel, table.texels);
    std::vector<Piece> met, bounded; // planes first
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const SurfacePieces pieces(static_cast<std::uint32_t>(i), surfaces[i], origin, met, bounded);
        std::visit(pieces, surfaces[i].shape);
        table.rows.push_back(row_of(surfaces[i]));
        table.rows.back().texture = textures.row_of(surfaces[i].material);
    }
    table.planes = static_cast<std::uint32_t>(met.size());
    std::vector<BvhBox> boxes;
    for (const Piece& piece : bounded)
        boxes.push_back(piece.box);
    BoxTree tree = build_box_tree(boxes);
    for (const std::uint32_t i : tree.order)
        met.push_back(bounded[i]);
    for (const Piece& piece : met)
        table.primitives.push_back(piece.primitive);
    table.met = static_cast<std::uint32_t>(met.size());
    for (std::size_t i = 0; i < met.size(); ++i)
        add_details(met[i], i, table.primitives);
    for (shared::BvhNode& node : tree.nodes)
        node.leaf += node.leaf != 0 ? 8 * table.planes : 0;
    table.nodes = std::move(tree.nodes);
    return table;
}

BvhBox box_of(const shared::SurfacePrimitive& piece) {
    BvhBox box;
    if (piece.shape == SURFACE_TRIANGLES) {
        for (const glm::vec3& corner : {piece.a, piece.b, piece.c})
            box.add(corner);
    } else { // a ball or disk: the box errs by the rounding of its middle and radius
        const float around = piece.c.x * 1.000001f;
        box.add(piece.a - around);
        box.add(piece.a + around);
    }
    return box;
}

double area_of(const shared::SurfacePrimitive& piece) {
    if (piece.shape == SURFACE_TRIANGLES)
        return 0.5 * glm::length(glm::cross(glm::dvec3(piece.b) - glm::dvec3(piece.a),
                                            glm::dvec3(piece.c) - glm::dvec3(piece.a)));
    const double radius = piece.c.x;
    return piece.shape == SURFACE_PLANE
               ? 0.0
               : (piece.shape == SURFACE_SPHERE ? 4.0 : 1.0) * std::numbers::pi * radius * radius;
}

int material_bits(const std::vector<Surface>& surfaces) {
    int bits = 0;
    for (const Surface& surface : surfaces)
        bits |= 1 << code_of(surface.material);
    for (const Surface& surface : surfaces)
        if (const auto* mesh = std::get_if<TriangleSurface>(&surface.shape))
            bits |= mesh->normals.empty() ? 0 : 1 << SMOOTH_FACES;
    for (const Surface& surface : surfaces)
        bits |= surface.material.image ? 1 << TEXTURED : 0;
    return bits;
}

} // namespace vkvol
