#include "shining_pieces.h"

#include "alias_table.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

constexpr double least_area = 1e-30; // world units^2, of what is any light: powers of it have to be numbers

// From a middle.
glm::vec3 extent_of(const shared::SurfacePrimitive& piece) {
    return glm::vec3(piece.shape == SURFACE_TRIANGLES ? 0.0f : piece.c.x);
}

void add_box(const shared::SurfacePrimitive& piece, ShiningSurface& surface) {
    const glm::vec3 extent = extent_of(piece);
    glm::vec3 low = piece.a - extent, high = piece.a + extent;
    if (piece.shape == SURFACE_TRIANGLES) {
        low = glm::min(piece.a, glm::min(piece.b, piece.c));
        high = glm::max(piece.a, glm::max(piece.b, piece.c));
    }
    const bool first = surface.pieces.empty();
    surface.low = first ? low : glm::min(surface.low, low);
    surface.high = first ? high : glm::max(surface.high, high);
}

void add_rows(const SurfaceTable& table, ShiningSurface& surface, std::vector<shared::EmitterRow>& rows) {
    std::vector<double> areas;
    for (const std::uint32_t i : surface.pieces)
        areas.push_back(area_of(table.primitives[i]));
    for (const double area : areas)
        surface.area += area;
    surface.first = static_cast<std::uint32_t>(rows.size());
    if (!(surface.area >= least_area)) { // looks draw one that brings nothing
        surface.pieces = {0};
        areas = {1.0};
        surface.area = 0.0;
    }
    const std::vector<shared::AliasEntry> alias = make_alias_table(areas);
    for (std::size_t i = 0; i < areas.size(); ++i)
        rows.push_back({alias[i], 0.0f, surface.pieces[i]});
    surface.count = static_cast<std::uint32_t>(areas.size());
}

} // namespace

ShiningPieces find_shining_pieces(const std::vector<Light>& lights, const SurfaceTable& surfaces) {
    ShiningPieces found;
    std::vector<ShiningSurface*> of_row(surfaces.rows.size());
    for (const Light& light : lights)
        if (is_shining_surface(light)) {
            const auto body = std::size_t(body_of(light));
            of_row[body] = &found.surfaces[body_of(light)];
            of_row[body]->sides = surfaces.rows[body].sides;
        }
    for (std::uint32_t i = 0; i < surfaces.met && !found.surfaces.empty(); ++i) {
        const shared::SurfacePrimitive& piece = surfaces.primitives[i];
        if (ShiningSurface* surface = of_row[piece.surface]) {
            add_box(piece, *surface);
            surface->pieces.push_back(i);
        }
    }
    for (auto& [body, surface] : found.surfaces)
        add_rows(surfaces, surface, found.rows);
    return found;
}

} // namespace vkvol
