// A medium that repeats, unfolded: rays go straight on, without end, and the density at a point is that of the point's
// place in the domain. The renderer itself moves rays from face to face and looks at the domain alone: nothing of that
// is here.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mapped.h"
#include "medium.h"

namespace reference {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Corners {
    glm::dvec3 low{infinity}, high{-infinity};
};

Corners corners_of(const Medium& medium) {
    glm::dvec3 low, high;
    glm::dmat4 to_world = glm::inverse(medium.to_unmoved);
    if (const Grid* grid = medium.grid()) {
        low = grid->lower;
        high = grid->lower + grid->size - 1;
        to_world = glm::dmat4(grid->linear);
        to_world[3] = glm::dvec4(grid->translation, 1.0);
    } else if (const auto* sphere = std::get_if<vkvol::Sphere>(&medium.shape)) {
        low = sphere->center - sphere->radius;
        high = sphere->center + sphere->radius;
    } else if (const auto* box = std::get_if<vkvol::Box>(&medium.shape)) {
        low = box->center - 0.5 * box->size;
        high = box->center + 0.5 * box->size;
    } else {
        throw std::runtime_error("the reference unfolds grids, spheres and boxes");
    }
    Corners corners;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 world(to_world * glm::dvec4(glm::mix(low, high, pick), 1.0));
        corners.low = glm::min(corners.low, world);
        corners.high = glm::max(corners.high, world);
    }
    return corners;
}

} // namespace

glm::dvec3 folded(const Medium& medium, const glm::dvec3& world) {
    glm::dvec3 place = world;
    if (medium.periodic)
        for (int axis = 0; axis < 3; ++axis)
            if (const double size = medium.periodic->size()[axis]; size > 0.0)
                place[axis] -= size * std::floor((world[axis] - medium.periodic->low[axis]) / size);
    return place;
}

Interval unfolded_support(const Medium& medium, const Ray& ray) {
    const Corners corners = corners_of(medium);
    Interval part{0.0, infinity};
    for (int axis = 0; axis < 3; ++axis) {
        if (medium.periodic->size()[axis] > 0.0)
            continue;
        const double from = ray.origin[axis], d = ray.direction[axis];
        if (d == 0.0 && (from < corners.low[axis] || from > corners.high[axis]))
            return {};
        if (d == 0.0)
            continue;
        const auto [first, last] = std::minmax({(corners.low[axis] - from) / d, (corners.high[axis] - from) / d});
        part = clip(part, {first, last});
    }
    return part;
}

double unfolded_density(const Medium& medium, const glm::dvec3& world) {
    const glm::dvec3 place = folded(medium, world);
    if (const Grid* grid = medium.grid()) {
        const glm::dvec3 index = grid->to_index(place), within = index - glm::dvec3(grid->lower);
        const bool inside = !glm::any(glm::lessThan(within, glm::dvec3(0.0))) &&
                            !glm::any(glm::greaterThan(within, glm::dvec3(grid->size - 1)));
        return inside ? medium.density(index) : 0.0; // a map may have more than nothing where there is no value
    }
    const glm::dvec3 p(medium.to_unmoved * glm::dvec4(place, 1.0));
    const auto* sphere = std::get_if<vkvol::Sphere>(&medium.shape);
    const auto* box = std::get_if<vkvol::Box>(&medium.shape);
    const bool inside = sphere ? glm::distance(p, sphere->center) < sphere->radius
                               : !glm::any(glm::greaterThan(glm::abs(p - box->center), 0.5 * box->size));
    return inside ? medium.density(p) : 0.0;
}

double largest_density(const Medium& medium) {
    if (const Grid* grid = medium.grid())
        return mapped_extremes(medium.map, 0.0, *std::max_element(grid->values.begin(), grid->values.end())).most;
    if (medium.layers && medium.layers->scale_height > 0.0)
        return std::exp((medium.layers->reference - medium.layers->bottom) / medium.layers->scale_height);
    if (medium.layers)
        return mapped_extremes(medium.map, 0.0, medium.layers->top - medium.layers->bottom).most;
    return medium.noise ? noise_bound(*medium.noise) : 1.0;
}

} // namespace reference
