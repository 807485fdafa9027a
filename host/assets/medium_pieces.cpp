#include "medium_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "layers.h"
#include "noise.h"
#include "placement.h"

namespace vkvol {

namespace {

constexpr int pieces = 16; // along an edge of a sphere or a box, at the finest

Pieces pieces_of_cells(const MajorantGrid& grid, glm::ivec3 index_base) {
    Pieces found{glm::dvec3(0.5 * grid.cell), {}};
    const glm::dvec3 base(grid.origin - index_base);
    std::size_t i = 0;
    for (int x = 0; x < grid.dims.x; ++x)
        for (int y = 0; y < grid.dims.y; ++y)
            for (int z = 0; z < grid.dims.z; ++z, ++i)
                if (grid.bounds[i] > 0.0f)
                    found.parts.push_back(
                        {base + double(grid.cell) * (glm::dvec3(x, y, z) + 0.5), double(grid.bounds[i])});
    return found;
}

// Pieces of a ball or a cube, `count` along an edge.
Pieces pieces_of_shape(bool is_ball, double bound, int count) {
    const glm::dvec3 half(1.0 / count);
    Pieces found{half, {}};
    for (int x = 0; x < count; ++x)
        for (int y = 0; y < count; ++y)
            for (int z = 0; z < count; ++z) {
                const glm::dvec3 middle = (2.0 * glm::dvec3(x, y, z) + 1.0) / double(count) - 1.0;
                const glm::dvec3 nearest = glm::max(glm::abs(middle) - half, 0.0);
                if (!is_ball || glm::dot(nearest, nearest) < 1.0)
                    found.parts.push_back({middle, bound});
            }
    return found;
}

// How often pieces of this size can be doubled without being longer than half of `finest`.
int level_for(double size, double finest, int most) {
    const double doublings = std::floor(std::log2(finest / (2.0 * size)));
    return static_cast<int>(std::clamp(doublings, 0.0, double(most)));
}

} // namespace

bool has_matter(const Volume& volume, const LoadedMedium& loaded) {
    const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
    return (volume.sigma_a + volume.sigma_s) * volume.density_scale != Rgb(0.0) && (loaded.field || !is_grid);
}

double usual_cell(const Volume& volume, const LoadedMedium& loaded) {
    if (is_everywhere(volume))
        return loaded.is_layered ? layer_box(volume).size[volume.layers->axis] / double(loaded.majorants->bounds.size())
                                 : std::numeric_limits<double>::infinity();
    return loaded.field ? loaded.majorants->cell * loaded.field->voxel_size()
                        : diagonal_of(volume, loaded) / std::sqrt(3.0) / pieces;
}

const Pieces& PieceStore::of(const Volume& volume, const LoadedMedium& loaded, double finest) {
    constexpr int most_grid_levels = 16, most_shape_levels = 3; // 2 pieces along an edge
    const double size = usual_cell(volume, loaded);
    if (loaded.field) // whose bounds the scene's scale is in already
        return of_grid(loaded, level_for(size, finest, most_grid_levels));
    if (loaded.is_layered)
        return of_grid(loaded, 0);
    const double density = volume.noise ? noise_bound(*volume.noise) : 1.0;
    if (loaded.inside)
        return of_mesh(*loaded.inside, density * scale_, level_for(loaded.inside->edge, finest, most_grid_levels));
    return of_shape(std::holds_alternative<Sphere>(volume.shape), density * scale_,
                    level_for(size, finest, most_shape_levels));
}

const Pieces& PieceStore::of_grid(const LoadedMedium& loaded, int level) {
    auto& levels = grids_[loaded.majorants.get()];
    while (levels.size() <= std::size_t(level)) {
        std::shared_ptr<const MajorantGrid> cells = loaded.majorants;
        if (!levels.empty())
            cells = std::make_shared<const MajorantGrid>(merge_cells(*levels.back().first));
        levels.emplace_back(cells, pieces_of_cells(*cells, loaded.field ? index_base(*loaded.field) : glm::ivec3(0)));
    }
    return levels[std::size_t(level)].second;
}

const Pieces& PieceStore::of_mesh(const InsideLattice& inside, double bound, int level) {
    const auto [found, is_new] = meshes_.try_emplace({&inside, bound, level});
    if (!is_new)
        return found->second;
    MajorantGrid cells = inside.cells;
    for (int i = 0; i < level; ++i)
        cells = merge_cells(cells);
    found->second = pieces_of_cells(cells, glm::ivec3(0));
    found->second.half *= inside.edge;
    for (Pieces::Piece& piece : found->second.parts)
        piece = {inside.low + inside.edge * piece.middle, bound};
    return found->second;
}

const Pieces& PieceStore::of_shape(bool is_ball, double bound, int level) {
    const auto [found, is_new] = shapes_.try_emplace({is_ball, bound, level});
    if (is_new)
        found->second = pieces_of_shape(is_ball, bound, pieces >> level);
    return found->second;
}

} // namespace vkvol
