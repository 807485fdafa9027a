#include "superposition.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "error.h"
#include "noise.h"
#include "placement.h"
#include "shared/estimators.h"

namespace vkvol {

namespace {

constexpr double most_cells = 1 << 21;
constexpr int pieces = 16; // along an edge of a sphere or a box: its parts that are bounded by themselves

// A part of a medium: a box of its space, and what bounds the extinction there.
struct Piece {
    glm::dvec3 middle, half;
    double bound; // [1 / world unit]
};

bool has_matter(const Volume& volume, const LoadedMedium& loaded) {
    const bool is_grid = std::holds_alternative<GridFile>(volume.shape);
    return (volume.sigma_a + volume.sigma_s) * volume.density_scale != Rgb(0.0) && (loaded.field || !is_grid);
}

std::vector<Piece> pieces_of_grid(const LoadedMedium& loaded, double sigma_t) {
    const MajorantGrid& grid = *loaded.majorants;
    const glm::dvec3 base(grid.origin - index_base(*loaded.field));
    const glm::dvec3 half(0.5 * grid.cell);
    std::vector<Piece> found;
    std::size_t i = 0;
    for (int x = 0; x < grid.dims.x; ++x)
        for (int y = 0; y < grid.dims.y; ++y)
            for (int z = 0; z < grid.dims.z; ++z, ++i)
                if (grid.bounds[i] > 0.0f)
                    found.push_back({base + double(grid.cell) * (glm::dvec3(x, y, z) + 0.5), half,
                                     sigma_t * double(grid.bounds[i])});
    return found;
}

// Of a ball or a cube.
std::vector<Piece> pieces_of_shape(bool is_ball, double bound) {
    const glm::dvec3 half(1.0 / pieces);
    std::vector<Piece> found;
    for (int x = 0; x < pieces; ++x)
        for (int y = 0; y < pieces; ++y)
            for (int z = 0; z < pieces; ++z) {
                const glm::dvec3 middle = (2.0 * glm::dvec3(x, y, z) + 1.0) / double(pieces) - 1.0;
                const glm::dvec3 nearest = glm::max(glm::abs(middle) - half, 0.0);
                if (!is_ball || glm::dot(nearest, nearest) < 1.0)
                    found.push_back({middle, half, bound});
            }
    return found;
}

std::vector<Piece> pieces_of(const Scene& scene, const Volume& volume, const LoadedMedium& loaded) {
    const double sigma_t = largest(world_sigma_t(volume, loaded.field ? &*loaded.field : nullptr));
    if (loaded.field) // whose bounds the scene's scale is in already
        return pieces_of_grid(loaded, sigma_t);
    const double density = volume.noise ? noise_bound(*volume.noise) : 1.0;
    return pieces_of_shape(std::holds_alternative<Sphere>(volume.shape),
                           sigma_t * density * scene.settings.majorant_scale);
}

// A box along the axes around a box of another space.
struct AxisBox {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
};

AxisBox around(const glm::dmat4& map, glm::dvec3 middle, glm::dvec3 half) {
    const glm::dvec3 there(map * glm::dvec4(middle, 1.0));
    const glm::dvec3 reach = glm::abs(glm::dvec3(map[0])) * half.x + glm::abs(glm::dvec3(map[1])) * half.y +
                             glm::abs(glm::dvec3(map[2])) * half.z;
    return {there - reach, there + reach};
}

// World units: as large as the cells that the medium has by itself, or would have.
double usual_cell(const Volume& volume, const LoadedMedium& loaded) {
    return loaded.field ? loaded.majorants->cell * loaded.field->voxel_size()
                        : diagonal_of(volume, loaded) / std::sqrt(3.0) / pieces;
}

// The superposition's space: the box around all, in cells as small as the smallest that any of them wants, as far as
// there may be so many.
void lay_out(const Scene& scene, Media media, const std::vector<std::size_t>& members, Superposition& whole) {
    AxisBox box;
    double wanted = std::numeric_limits<double>::infinity();
    for (const std::size_t i : members) {
        const MediumBounds bounds = medium_bounds(media[i]);
        const AxisBox other = around(medium_to_world(scene.volumes[i], media[i]), 0.5 * (bounds.low + bounds.high),
                                     0.5 * (bounds.high - bounds.low));
        box = {glm::min(box.low, other.low), glm::max(box.high, other.high)};
        wanted = std::min(wanted, usual_cell(scene.volumes[i], media[i]));
    }
    const glm::dvec3 size = box.high - box.low;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest < 1e6 * 8.0 * wanted))
        throw InputError(
            fmt::format("the volumes reach {:.3g} world units across, a million times what the smallest of "
                        "them measures; move them together, or leave some out",
                        longest));
    whole.origin = 0.5 * (box.low + box.high);
    whole.edge = std::max({wanted, std::cbrt(size.x * size.y * size.z / most_cells), longest / 1024.0});
    whole.edge = std::min(whole.edge, longest / 4.0);
    const glm::dvec3 half = 0.5 * size / whole.edge;
    whole.cells.cell = 1;
    whole.cells.origin =
        glm::ivec3(glm::floor(-half - 1e-3)); // a little more, for what rounding may do to a box's faces
    whole.cells.dims = glm::ivec3(glm::ceil(half + 1e-3)) - whole.cells.origin;
}

// Raises the bounds, 0 before, of the cells that pieces of a medium reach into, and lists these in `touched`.
void raise(const std::vector<Piece>& found, const glm::dmat4& to_cells, const MajorantGrid& cells,
           std::vector<float>& bounds, std::vector<std::uint32_t>& touched) {
    for (const Piece& piece : found) {
        // A point on the device may be as far aside as single precision lets it be.
        const AxisBox box = around(to_cells, piece.middle, piece.half);
        const glm::dvec3 margin = 1e-4 + 1e-6 * glm::max(glm::abs(box.low), glm::abs(box.high));
        const glm::ivec3 low =
            glm::clamp(glm::ivec3(glm::floor(box.low - margin)) - cells.origin, glm::ivec3(0), cells.dims - 1);
        const glm::ivec3 high =
            glm::clamp(glm::ivec3(glm::floor(box.high + margin)) - cells.origin, glm::ivec3(0), cells.dims - 1);
        for (int x = low.x; x <= high.x; ++x)
            for (int y = low.y; y <= high.y; ++y)
                for (int z = low.z; z <= high.z; ++z) {
                    const auto i = static_cast<std::uint32_t>((x * cells.dims.y + y) * cells.dims.z + z);
                    if (bounds[i] == 0.0f)
                        touched.push_back(i);
                    bounds[i] = std::max(bounds[i], static_cast<float>(piece.bound * (1.0 + 1e-6)));
                }
    }
}

struct Overlap {
    std::uint32_t cell, medium;
};

void list_overlaps(const std::vector<Overlap>& found, std::size_t cells, Superposition& whole) {
    std::vector<std::uint32_t> count(cells, 0);
    for (const Overlap& overlap : found)
        ++count[overlap.cell];
    whole.most_overlaps = count.empty() ? 0 : *std::max_element(count.begin(), count.end());
    whole.overlaps.resize(cells + 1 + found.size());
    auto next = static_cast<std::uint32_t>(cells + 1);
    for (std::size_t i = 0; i < cells; ++i) {
        whole.overlaps[i] = next;
        next += count[i];
    }
    whole.overlaps[cells] = next;
    std::vector<std::uint32_t> place(whole.overlaps.begin(), whole.overlaps.begin() + std::ptrdiff_t(cells));
    for (const Overlap& overlap : found)
        whole.overlaps[place[overlap.cell]++] = overlap.medium;
}

} // namespace

Superposition superpose(const Scene& scene, Media media, const Method& method) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (has_matter(scene.volumes[i], media[i]))
            members.push_back(i);
    Superposition whole;
    if (members.empty())
        return whole;
    lay_out(scene, media, members, whole);
    const std::size_t count =
        std::size_t(whole.cells.dims.x) * std::size_t(whole.cells.dims.y) * std::size_t(whole.cells.dims.z);
    whole.cells.bounds.assign(count, 0.0f);
    const glm::dmat4 to_cells =
        glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / whole.edge)) * glm::translate(glm::dmat4(1.0), -whole.origin);
    std::vector<float> bounds(count, 0.0f); // of one medium
    std::vector<std::uint32_t> touched;
    std::vector<Overlap> found;
    for (const std::size_t i : members) {
        raise(pieces_of(scene, scene.volumes[i], media[i]), to_cells * medium_to_world(scene.volumes[i], media[i]),
              whole.cells, bounds, touched);
        for (const std::uint32_t cell : touched) {
            whole.cells.bounds[cell] += bounds[cell];
            found.push_back({cell, static_cast<std::uint32_t>(i)});
            bounds[cell] = 0.0f;
        }
        touched.clear();
    }
    list_overlaps(found, count, whole);
    // Worth the look at how far they reach where there are some.
    const auto empty = std::count(whole.cells.bounds.begin(), whole.cells.bounds.end(), 0.0f);
    whole.cells.leaps = leaps(method) && 8 * std::size_t(empty) > count;
    return whole;
}

} // namespace vkvol
