#include "surface_gaps.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <span>

#include "medium_outline.h"
#include "shared/constants.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

constexpr double seen = 0.01; // of a surface's size, or of a mean free path
constexpr double seen_of_thickness = 0.1;

// Where a medium is, and its extinction where it is densest [1 / world unit].
struct Extinction {
    WorldBox box;
    double most;
};

// The densest first.
std::vector<Extinction> extinctions(const Scene& scene, const Assets& assets) {
    std::vector<Extinction> found;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        const MediumOutline outline = make_outline(scene, scene.volumes[i], assets.media[i], false);
        if (!outline.exists)
            continue;
        constexpr double endless = std::numeric_limits<double>::infinity();
        const bool is_endless = is_everywhere(scene.volumes[i]);
        found.push_back({is_endless ? WorldBox{glm::dvec3(-endless), glm::dvec3(endless)} : world_box(outline),
                         outline.sigma_t * outline.densest});
    }
    std::sort(found.begin(), found.end(), [](const Extinction& a, const Extinction& b) { return a.most > b.most; });
    return found;
}

double gap_at(const SurfaceBounds& bounds, const glm::dvec3& origin) {
    const glm::dvec3 reach = glm::max(glm::abs(bounds.low - origin), glm::abs(bounds.high - origin));
    return SURFACE_SPARE * std::max({reach.x, reach.y, reach.z});
}

// How far rays are kept off what they meet of a surface, and how many times what would be seen: of its size, of mean
// free paths, or of glass' thickness, whose other side must not be missed.
struct Gap {
    enum class Of { size, free_path, thickness };
    double apart = 0.0, times = 0.0;
    Of of = Of::size;
};

bool meet(const SurfaceBounds& piece, const WorldBox& box) {
    return glm::all(glm::lessThanEqual(piece.low, box.high)) && glm::all(glm::greaterThanEqual(piece.high, box.low));
}

bool meet(const PlaneSurface& plane, const WorldBox& box) {
    const glm::dvec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    return std::abs(glm::dot(plane.normal, middle - plane.point)) <= glm::dot(glm::abs(plane.normal), half);
}

// The largest of the pieces of a surface that are in the medium: each triangle has its own. Of no more of them in all
// than `patience`, which is of some tenths of a second. `bounds`: of the surface; of a plane none.
double gap_in(const Surface& surface, const std::optional<SurfaceBounds>& bounds, const WorldBox& box,
              const glm::dvec3& origin, std::size_t& patience) {
    if (const auto* plane = std::get_if<PlaneSurface>(&surface.shape)) // by the distance of where rays leave it
        return meet(*plane, box) && std::isfinite(box.low.x) ? gap_at({box.low, box.high}, origin) : 0.0;
    const auto* mesh = std::get_if<TriangleSurface>(&surface.shape);
    if (!mesh || !meet(*bounds, box))
        return meet(*bounds, box) ? gap_at(*bounds, origin) : 0.0;
    double apart = 0.0;
    if (mesh->triangles.size() > patience)
        return apart;
    patience -= mesh->triangles.size();
    for (const glm::uvec3& t : mesh->triangles) {
        const glm::dvec3 &a = mesh->vertices[t.x], &b = mesh->vertices[t.y], &c = mesh->vertices[t.z];
        const SurfaceBounds piece{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
        apart = meet(piece, box) ? std::max(apart, gap_at(piece, origin)) : apart;
    }
    return apart;
}

Gap gap_of(const Surface& surface, std::span<const Extinction> media, const glm::dvec3& origin, std::size_t& patience) {
    Gap worst;
    double most = std::numeric_limits<double>::infinity(); // of a plane
    const std::optional<SurfaceBounds> bounds = bounds_of(std::span(&surface, 1));
    if (bounds) {
        most = gap_at(*bounds, origin);
        const glm::dvec3 size = bounds->high - bounds->low;
        worst = {most, most / (seen * glm::length(size)), Gap::Of::size};
        const double thickness = std::min({size.x, size.y, size.z}), times = most / (seen_of_thickness * thickness);
        if (surface.material.kind == MaterialKind::dielectric && thickness > 0.0 && times > worst.times)
            worst = {most, times, Gap::Of::thickness};
    }
    for (const Extinction& medium : media) {
        if (most * medium.most <= seen * std::max(1.0, worst.times))
            break;
        const double apart = gap_in(surface, bounds, medium.box, origin, patience), times = apart * medium.most / seen;
        worst = times > worst.times ? Gap{apart, times, Gap::Of::free_path} : worst;
    }
    return worst;
}

} // namespace

std::string surface_gap_warning(const Scene& scene, const Assets& assets, const glm::dvec3& origin) {
    const std::vector<Extinction> media = extinctions(scene, assets);
    Gap worst;
    std::size_t patience = 20'000'000;
    std::string place;
    std::size_t count = 0;
    for (const Surface& surface : scene.surfaces) {
        const Gap gap = gap_of(surface, media, origin, patience);
        count += gap.times > 1.0 ? 1 : 0;
        if (gap.times <= std::max(1.0, worst.times))
            continue;
        worst = gap;
        place = surface.place.empty() ? "" : surface.place + ": ";
    }
    if (count == 0)
        return "";
    const std::string share =
        worst.of == Gap::Of::free_path ? fmt::format("{:.2g} mean free paths of the medium there", seen * worst.times)
        : worst.of == Gap::Of::thickness
            ? fmt::format(
                  "{:.2g} times its glass' thickness (from 1 on, or less of rough glass, light misses the other "
                  "side, and the glass is dark)",
                  seen_of_thickness * worst.times)
            : fmt::format("{:.2g} % of its size", 100.0 * seen * worst.times);
    return fmt::format("{}{}rays that leave this surface begin {:.2g} world units off it, {}, since it reaches {:.2g} "
                       "from the middle of the scene, where single precision knows places no better; move together "
                       "what is far apart, leave it out, or take a <plane> for an endless ground",
                       place, count > 1 ? fmt::format("(and of {} others) ", count - 1) : "", worst.apart, share,
                       worst.apart / SURFACE_SPARE);
}

} // namespace vkvol
