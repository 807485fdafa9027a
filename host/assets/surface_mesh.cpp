#include "surface_mesh.h"

#include <fmt/format.h>
#include <limits>

#include "error.h"
#include "mesh.h"
#include "polygons.h"

namespace vkvol {

namespace {

TriangleSurface load(const MeshSurface& mesh, const glm::dmat4& transform, bool closed) {
    if (closed) {
        Mesh loaded = load_mesh({{mesh.file}}, transform);
        return {std::move(loaded.vertices), std::move(loaded.triangles)};
    }
    Polygons obj = read_polygons(mesh.file);
    for (glm::dvec3& vertex : obj.vertices)
        vertex = glm::dvec3(transform * glm::dvec4(vertex, 1.0));
    if (glm::determinant(glm::dmat3(transform)) < 0.0) // a mirror turns them inside out
        for (glm::uvec3& triangle : obj.triangles)
            std::swap(triangle.y, triangle.z);
    return {std::move(obj.vertices), std::move(obj.triangles)};
}

} // namespace

Scene with_surface_meshes(Scene scene) {
    for (Surface& surface : scene.surfaces)
        if (const auto* mesh = std::get_if<MeshSurface>(&surface.shape)) {
            try {
                surface.shape = load(*mesh, surface.transform, surface.material.kind == MaterialKind::dielectric);
            } catch (const InputError& error) { // of the file; the scene says who asked for it
                throw InputError(surface.place.empty() ? error.what()
                                                       : fmt::format("{}: {}", surface.place, error.what()));
            }
        }
    return scene;
}

std::optional<SurfaceBounds> bounds_of(const std::vector<Surface>& surfaces) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    SurfaceBounds bounds{glm::dvec3(infinite), glm::dvec3(-infinite)};
    const auto add = [&](const glm::dvec3& middle, double reach) {
        bounds.low = glm::min(bounds.low, middle - reach);
        bounds.high = glm::max(bounds.high, middle + reach);
    };
    for (const Surface& surface : surfaces) {
        if (const auto* ball = std::get_if<BallSurface>(&surface.shape))
            add(ball->center, ball->radius);
        if (const auto* disk = std::get_if<DiskSurface>(&surface.shape))
            add(disk->center, disk->radius);
        if (const auto* rectangle = std::get_if<RectangleSurface>(&surface.shape))
            for (const double sign : {-1.0, 1.0}) {
                add(rectangle->center + sign * (rectangle->edge_u + rectangle->edge_v), 0.0);
                add(rectangle->center + sign * (rectangle->edge_u - rectangle->edge_v), 0.0);
            }
        if (const auto* mesh = std::get_if<TriangleSurface>(&surface.shape))
            for (const glm::dvec3& vertex : mesh->vertices)
                add(vertex, 0.0);
    }
    return bounds.low.x <= bounds.high.x ? std::optional(bounds) : std::nullopt;
}

double reach_of_surfaces(const std::vector<Surface>& surfaces, const glm::dvec3& origin) {
    for (const Surface& surface : surfaces)
        if (std::holds_alternative<PlaneSurface>(surface.shape))
            return std::numeric_limits<double>::infinity();
    const std::optional<SurfaceBounds> bounds = bounds_of(surfaces);
    return bounds ? glm::length(glm::max(glm::abs(bounds->low - origin), glm::abs(bounds->high - origin))) : 0.0;
}

} // namespace vkvol
