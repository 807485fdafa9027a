#include "period.h"

#include <algorithm>
#include <limits>

#include "medium_pieces.h"
#include "placement.h"
#include "surface_mesh.h"

namespace vkvol {

namespace {

struct Range {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void take_in(glm::dvec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

// What rounding leaves of a turn by half a circle is nothing, which without bounds would be far.
glm::dmat4 without_rounding(glm::dmat4 map) {
    for (int column = 0; column < 3; ++column) {
        const glm::dvec3 size = glm::abs(glm::dvec3(map[column]));
        for (int row = 0; row < 3; ++row)
            if (size[row] < 1e-9 * std::max({size.x, size.y, size.z}))
                map[column][row] = 0.0;
    }
    return map;
}

void take_in(const Volume& volume, const LoadedMedium& loaded, Range& range) {
    const MediumBounds bounds = medium_bounds(loaded);
    Volume turned = volume; // before the reach of layers is: 1e20 times what rounding leaves
    turned.transform = without_rounding(volume.transform);
    const glm::dmat4 to_world = without_rounding(medium_to_world(turned, loaded));
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
        range.take_in(glm::dvec3(to_world * glm::dvec4(glm::mix(bounds.low, bounds.high, pick), 1.0)));
    }
}

// Range that holds all there is.
Range range_of(const Scene& scene, Media media) {
    Range range;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (has_matter(scene.volumes[i], media[i]))
            take_in(scene.volumes[i], media[i], range);
    if (const std::optional<SurfaceBounds> bounds = bounds_of(scene.surfaces)) {
        range.take_in(bounds->low);
        range.take_in(bounds->high);
    }
    // Planes lie along the axes that repeat, see render_limits.cpp; along others they have no end but across.
    for (const Surface& surface : scene.surfaces)
        if (const auto* plane = std::get_if<PlaneSurface>(&surface.shape)) {
            const glm::dvec3 along = everywhere_reach * (1.0 - glm::step(1.0, glm::abs(plane->normal)));
            range.take_in(plane->point - along);
            range.take_in(plane->point + along);
        }
    if (glm::any(glm::greaterThan(range.low, range.high))) // nothing at all: rays leave from where they begin
        range.take_in(scene.camera.position);
    return range;
}

} // namespace

shared::PeriodParams make_period(const Scene& scene, Media media, glm::dvec3 origin) {
    shared::PeriodParams params{};
    if (!scene.periodic)
        return params;
    const Range range = range_of(scene, media);
    params.low = scene.periodic->low - origin;
    params.size = scene.periodic->size();
    for (int axis = 0; axis < 3; ++axis) {
        const bool repeats = params.size[axis] > 0.0f;
        constexpr float infinite = std::numeric_limits<float>::max();
        // More than nothing, and than rounding, where all that there is is flat.
        const glm::dvec3 size = scene.periodic->size();
        const double low = range.low[axis] - origin[axis], high = range.high[axis] - origin[axis];
        const double margin =
            1e-5 * std::max({high - low, size.x, size.y, size.z}) + 0x1p-20 * std::max(std::abs(low), std::abs(high));
        params.range_low[axis] = repeats ? -infinite : static_cast<float>(low - margin);
        params.range_high[axis] = repeats ? infinite : static_cast<float>(high + margin);
    }
    return params;
}

} // namespace vkvol
